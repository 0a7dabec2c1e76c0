/**
 * Types of contactlab_springs.mjs, which says more on each argument.
 *
 * SPDX-License-Identifier: MIT
 * Copyright (c) the authors of contactlab
 */

/** Three numbers that are read. */
export type Vector = readonly number[] | Float64Array;

/** Three numbers that are set. */
export type Written = number[] | Float64Array;

/** Returns the length of the state of a contact with n springs. */
export function stateLength(n: number): number;

/**
 * Takes one step of a contact with n springs, n even. Returns the friction work in J.
 *
 * The state, all zero before first touch, and the force in N on the first body are changed. Throws a RangeError for
 * an odd n or a state that is too short.
 */
export function step(state: Written, n: number, moved: Vector, normal: Vector, radius: number, limit: number,
  unit: number, modulus: number, force: Written): number;

/** Takes one step of a contact whose normal force is damped. Returns the energy lost in shear in J. */
export function dampedStep(state: Written, n: number, moved: Vector, normal: Vector, radius: number, limit: number,
  unit: number, modulus: number, force: Written, elastic: number, damping: number, velocity: Vector,
  time: number): number;
