/**
 * Types of contactlab_bounce.mjs where it is required by CommonJS (Node from 20.19): those of contactlab_bounce.d.mts.
 *
 * SPDX-License-Identifier: MIT
 * Copyright (c) the authors of contactlab
 */

import type * as module from "./contactlab_bounce.mjs" with {"resolution-mode": "import"};

export type * from "./contactlab_bounce.mjs" with {"resolution-mode": "import"};
export const bounce: typeof module.bounce;
export const rebound: typeof module.rebound;
export const impact: typeof module.impact;
export const BALLS: typeof module.BALLS;
