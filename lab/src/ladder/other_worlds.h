#pragma once

#include <string>

#include "hires/geometry/shape.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/simulation/scene.h"

namespace hires::lab::ladder {

/// The surface of a shape as triangles with edges of at most about `edge` [m]. Round shapes get
/// corners on the shape itself; a mesh is given back as it is.
geometry::TriangleMesh Triangulated(const geometry::Shape& shape, double edge);

/// The same world in which static bodies whose name begins with `prefix` are loose: solid, of that
/// mass [kg] each. They become models of their own and stand in `initial`.
world::World WithLoose(world::World world, const std::string& prefix, double mass);

/// ... in which static bodies, or loose objects, are made of triangles.
world::World WithMeshStatics(world::World world, double edge);
world::World WithMeshObjects(world::World world, double edge);

/// ... without static bodies of which no part is higher than `height` [m]: what a plan of the
/// building shows.
world::World WithHighStaticsOnly(world::World world, double height);

/// Another world for the same robot, which is told its place.
std::shared_ptr<const simulation::Scene> SceneIn(world::World world, const simulation::Scene& like);

int NumTriangles(const std::vector<geometry::Collision>& collisions);

}  // namespace hires::lab::ladder
