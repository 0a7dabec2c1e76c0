/**
 * Types of contactlab_bounce.mjs, which says more on each function.
 *
 * SPDX-License-Identifier: MIT
 * Copyright (c) the authors of contactlab
 */

/** Three numbers, as `[v.x, v.y, v.z]`. */
export type Vector = readonly [number, number, number];

/** A body in SI units: without a radius a wall, without a mass nothing moves it. */
export interface Body {
  radius?: number;
  mass?: number;
  /** Young's modulus; only the ratio of two bodies counts. Given for both bodies or for none. */
  young?: number;
  /** Poisson's ratio. If the other body has none, both are of one material. */
  poisson?: number;
  /** sqrt(inertia/(mass radius²)), from 0.01 to 1; by default that of a solid sphere, sqrt(2/5). */
  gyration_ratio?: number;
}

/** The first body, which has a radius and Poisson's ratio. */
export interface SphereBody extends Body {
  radius: number;
  poisson: number;
}

/** Coefficients of friction, and of restitution from 0 to 1 (1). */
export interface Contact {
  friction: number;
  restitution?: number;
}

/** Velocities in m/s and spins in rad/s after the collision. */
export interface Motion {
  /** False where the bodies part already: a normal the wrong way. */
  bounced: boolean;
  velocity: [number, number, number];
  spin: [number, number, number];
  otherVelocity: [number, number, number];
  otherSpin: [number, number, number];
}

/** One impact in scaled variables, the start first. */
export interface Impact {
  psi2: number;
  duration: number;
  /** The largest normal force. */
  peak: number;
  /** Over the duration. */
  time: number[];
  /** Friction over the largest limit. */
  force: number[];
  /** Friction coefficient times normal force, over the largest. */
  limit: number[];
  /** Contact radius over that of the elastic contact at its largest. */
  radius: number[];
  /** Of each step, the springs from the centre: 0 out of contact, 1 stuck, 2 and 3 slipping forth, back. */
  states: Uint8Array[];
}

/**
 * Returns velocities and spins of two bodies after their collision.
 *
 * A number as contact is the friction coefficient of elastic bodies. The normal leads from the centre of the first
 * body towards the other; any length. Throws a RangeError that names the argument which is wrong.
 */
export function bounce(one: SphereBody, other: Body, contact: number | Contact, normal: Vector, velocity: Vector,
  spin?: Vector, otherVelocity?: Vector, otherSpin?: Vector): Motion;

/** Returns psi2 of psi1, chi and the restitution (1), NaN for what is no number. */
export function rebound(psi1: number, chi: number, restitution?: number): number;

/** Returns the course of one impact of spheres, by springs (120) in steps (600). Throws a RangeError as bounce does. */
export function impact(psi1: number, chi: number, springs?: number, steps?: number, restitution?: number): Impact;

/** Balls to begin with: each a body for bounce and its contact. */
export const BALLS: Record<"football" | "tennisBall" | "billiardBall" | "superball",
  {body: SphereBody & {mass: number}; contact: Contact & {restitution: number}}>;
