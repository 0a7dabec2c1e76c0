/**
 * Types of contactlab_springs.mjs where it is required by CommonJS (Node from 20.19): those of contactlab_springs.d.mts.
 *
 * SPDX-License-Identifier: MIT
 * Copyright (c) the authors of contactlab
 */

import type * as module from "./contactlab_springs.mjs" with {"resolution-mode": "import"};

export type * from "./contactlab_springs.mjs" with {"resolution-mode": "import"};
export const stateLength: typeof module.stateLength;
export const step: typeof module.step;
export const dampedStep: typeof module.dampedStep;
