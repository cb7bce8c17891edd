"""How the chain touches the obstacle in Drake: by its own contact law, or by its distances.

Drake's compliant point contact is right to rounding where it has formulas, as for a sphere on a
cylinder. On a convex mesh of fine facets its search for the depth is not: 1e-5 L deep in 400 facets
its normal can be along an axis, 0.8 rad off, and in facets of 5e-4 L its depth is off by more than
1e-5 L. Its distance of a *point* from the same mesh is exact to 1e-16 L and 1e-13 rad. So on meshes
the spheres' centres are asked for that, and the force, stiffness times depth, is applied to the
links as an external one: distance, levers and the clamp's reaction are Drake's still.
"""

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import (
    AddContactMaterial,
    CollisionFilterDeclaration,
    GeometryId,
    GeometrySet,
    ProximityProperties,
    QueryObject,
    SceneGraph,
    Sphere,
)
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import CoulombFriction, ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.multibody.tree import MultibodyForces, RigidBody
from pydrake.systems.framework import Context

from analytic.numerics.arrays import Floats, Integers


class Beads:
    """The spheres, as places on links."""

    def __init__(
        self, links: list[RigidBody], carriers: Integers, places: Floats, radii: Floats
    ) -> None:
        self.links, self.carriers, self.places, self.radii = links, carriers, places, radii

    def body(self, bead: int) -> RigidBody:
        return self.links[int(self.carriers[bead])]


class CompliantContact:
    """Drake's own compliant point contact between spheres and obstacle."""

    def __init__(
        self,
        plant: MultibodyPlant,
        scene: SceneGraph,
        beads: Beads,
        thing: GeometryId,
        obstacle: RigidBody,
        material: ProximityProperties,
    ) -> None:
        self._plant, self._scene, self._obstacle = plant, scene, obstacle
        self._beads = [
            plant.RegisterCollisionGeometry(
                beads.body(i),
                RigidTransform(np.append(place, 0.0)),
                Sphere(radius),
                f"bead{i}",
                material,
            )
            for i, (place, radius) in enumerate(
                zip(beads.places, beads.radii.tolist(), strict=True)
            )
        ]
        self._all, self._thing, self._id = GeometrySet(self._beads), GeometrySet([thing]), thing
        filters = scene.collision_filter_manager()
        filters.Apply(CollisionFilterDeclaration().ExcludeWithin(self._all))

    def collide(self, root: Context, beads: frozenset[int]) -> None:
        """Let these beads, and no others, touch the obstacle, by filters on pairs."""
        filters = self._scene.collision_filter_manager(
            self._scene.GetMyMutableContextFromRoot(root)
        )
        filters.Apply(CollisionFilterDeclaration().ExcludeBetween(self._thing, self._all))
        if watched := [self._beads[i] for i in sorted(beads)]:
            allowed = CollisionFilterDeclaration().AllowBetween(self._thing, GeometrySet(watched))
            filters.Apply(allowed)

    def gap(self, query: QueryObject, bead: int, point: Floats) -> tuple[Floats, float]:
        pair = query.ComputeSignedDistancePairClosestPoints(self._beads[bead], self._id)
        outward = np.asarray(pair.nhat_BA_W)  # in whichever order Drake has them
        return outward if pair.id_B == self._id else -outward, float(pair.distance)

    def moments(self, context: Context, beads: Integers, forces: Floats) -> Floats:
        """Drake's generalised contact forces, in its own order [EI/L]."""
        instance = self._obstacle.model_instance()
        port = self._plant.get_generalized_contact_forces_output_port(instance)
        return np.array(port.Eval(context))


class DistanceContact:
    """Stiffness times the depth that Drake's distances have, as external forces."""

    def __init__(self, plant: MultibodyPlant, beads: Beads) -> None:
        self._plant, self._beads = plant, beads

    def collide(self, root: Context, beads: frozenset[int]) -> None:
        """The contacts are of watched beads only."""

    def gap(self, query: QueryObject, bead: int, point: Floats) -> tuple[Floats, float]:
        (found,) = query.ComputeSignedDistanceToPoint(np.append(point, 0.0))
        return np.asarray(found.grad_W), float(found.distance - self._beads.radii[bead])

    def moments(self, context: Context, beads: Integers, forces: Floats) -> Floats:
        """Of the forces that are applied; Drake's reactions then know of them, too."""
        total, applied = MultibodyForces(self._plant), []
        for bead, force in zip(beads.tolist(), forces, strict=True):
            body, place = self._beads.body(bead), np.append(self._beads.places[bead], 0.0)
            one = ExternallyAppliedSpatialForce()
            one.body_index, one.p_BoBq_B = body.index(), place
            one.F_Bq_W = SpatialForce(np.zeros(3), np.append(force, 0.0))
            applied.append(one)
            turned = body.EvalPoseInWorld(context).rotation() @ place
            body.AddInForceInWorld(context, one.F_Bq_W.Shift(-turned), total)
        port = self._plant.get_applied_spatial_force_input_port()
        port.FixValue(context, Value[list[ExternallyAppliedSpatialForce]](applied))
        return np.asarray(self._plant.CalcGeneralizedForces(context, total))


def material(stiffness: float) -> ProximityProperties:
    """What makes Drake's contact of two bodies as stiff as that, without friction and damping."""
    properties = ProximityProperties()
    AddContactMaterial(
        dissipation=0.0,
        point_stiffness=2 * stiffness,
        friction=CoulombFriction(0.0, 0.0),
        properties=properties,
    )
    return properties
