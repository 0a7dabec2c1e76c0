"""Draw one impact as a moving picture.

Examples
--------
  contactlab animate examples/steel_ball.toml --out impact.gif
  contactlab animate examples/thrown_ball.toml --ghost coulomb --out thrown.gif
  contactlab animate examples/foot.toml --ghost coulomb --out foot.gif
  contactlab animate --psi1 1.2 --chi 1.4412 --out contact.gif
"""

from __future__ import annotations

import argparse

from contactlab.cli import arguments as shared
from contactlab.cli.scene import add_scene, inputs
from contactlab.collisions.collision import Collision
from contactlab.impact.encounter import Encounter
from contactlab.impact.rigid_body import RigidBody
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.runs.simulation import Simulation

#: Words in the picture for laws with a name of their own.
GHOST_NAMES = {"coulomb": "rigid", "mindlin_cap": "capped spring"}


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the scene, the laws and the file."""
    add_scene(parser)
    words = "further tangential laws, drawn as outlines after the contact"
    shared.add_names(parser, "--ghost", words, default=[])
    shared.add_file(parser, "--out", ".gif", required=True)
    shared.add_progress(parser)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Run the impact, draw it and print the path; raise ``ImpactError`` if the impact fails."""
    file, scene, simulation = inputs(arguments)
    if scene.shape:
        raise ValueError("scene: must be a single impact, not a sweep; leave out [sweep]")
    encounter = None if file is None else file.encounter
    shared.tell_normal_spin(scene, simulation)
    if encounter is not None and isinstance(encounter.body, RigidBody):
        return _bodies(arguments, encounter, simulation)
    with shared.working(arguments.progress, "frames") as progress:
        result = simulation.run(scene, history="fields").check()
        ghosts = {
            GHOST_NAMES.get(name, name): Simulation(normal=simulation.normal, tangential=name)
            .run(scene)
            .check()
            for name in arguments.ghost
        }
        from contactlab.figures.animation import animate  # matplotlib only when drawing

        animate(arguments.out, result, ghosts=ghosts, progress=progress)
    print(arguments.out)
    return shared.OK


def _bodies(arguments: argparse.Namespace, encounter: Encounter, simulation: Simulation) -> int:
    """Draw an impact of a body that is no sphere."""
    with shared.working(arguments.progress, "frames") as progress:
        result = simulation.run(encounter.scene, history=True).check()
        collisions = {
            GHOST_NAMES.get(name, name): Collision.of(
                encounter, Simulation(tangential=name).run(encounter.scene).check()
            )
            for name in arguments.ghost
        }
        from contactlab.figures.body_animation import animate_bodies  # matplotlib only here

        whole = Collision.of(encounter, result)
        axes = result.scene.frame
        assert axes is not None  # of bodies that are no spheres
        animate_bodies(arguments.out, whole, axes, ghosts=collisions, progress=progress)
    print(arguments.out)
    return shared.OK
