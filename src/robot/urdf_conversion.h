#pragma once

#include <urdf_model/model.h>

#include <map>
#include <string>
#include <vector>

#include "robot/urdf/read_urdf.h"
#include "robot/urdf_outline.h"

namespace hires::robot {

/// Of each link, the lines of its collision shapes, in the parser's order.
using ShapeLines = std::map<std::string, std::vector<int>>;

/// Turns the parser's model into ours, reads its meshes and checks what the parser lets pass. The
/// hash is left at 0. `where` is the file's path, for messages and for relative meshes.
/// @param problems  gets what is wrong, of meshes that are missing or cannot be read, too, with
/// link or joint, line and remedy; the model is of use where it has none.
UrdfReading ConvertUrdf(const urdf::ModelInterface& urdf, const UrdfOutline& outline,
                        const ShapeLines& shape_lines, const std::string& where,
                        UrdfProblems* problems);

}  // namespace hires::robot
