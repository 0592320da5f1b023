#pragma once

#include "physics/contact_points.h"

namespace hires::physics {

/// Adds the points at which box A touches box B, and says whether there are any. Where faces meet
/// (the least way out is along a face's normal, or no more than a millimetre longer), these are the
/// corners of the lower of both faces clipped to the other one [Gottschalk, Lin, Manocha 1996;
/// Sutherland, Hodgman 1974]; else one point between two edges. Boxes that are parallel, or that
/// rounding alone keeps from being so, touch as any others: ODE 0.16.2's box-box collider finds
/// nothing in half of such poses.
bool AddBoxOnBox(const PlacedBox& a, const PlacedBox& b, ContactList* contacts);

}  // namespace hires::physics
