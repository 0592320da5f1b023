#pragma once

#include <vector>

#include "hires/base/action.h"
#include "hires/translation/translator.h"

namespace hires::translation {

struct ClassifyParams {
  double area_distance{0.25};       ///< [m] from an area's pose that counts as being there
  double area_yaw{0.35};            ///< [rad]
  double tucked_tolerance{0.1};     ///< [rad] sum over the arm's joints (PR2's tuck_arms)
  double posture_tolerance{0.3};    ///< [rad] likewise, other postures
  double torso_tolerance{0.02};     ///< [m]
  double placing_height{0.10};      ///< [m] above or below a placing area
  double tray_height{0.05};         ///< [m] above or below the tray
  double hysteresis{1.2};           ///< a symbol that holds already may be so many times off...
  double placing_hysteresis{0.02};  ///< [m] ... or so far beyond the edge
};

/// Geometry to symbols: RobotAt (the nearest area within tolerance, else the room that the robot is
/// in), HasArmPosture (`armunnamedposture` where none fits), HasTorsoPosture (`torsoposture`
/// likewise), Holding (`nothing` for an empty hand), On (placing areas and the tray; an object that
/// lies, is held or stands elsewhere has none; where areas overlap, the one whose middle is
/// nearest). A robot without an upper body has no postures and no hands. As knowledge::StateAtoms
/// sorts and spells them.
/// @param before  what held before, null: nothing. Noise at a border does not change it.
/// @throws base::ConfigError as robot::ForwardKinematics, for joints.
std::vector<base::Atom> AtomsOf(const TranslatorContext& context, const GeometricState& state,
                                const ClassifyParams& params = {},
                                const std::vector<base::Atom>* before = nullptr);

/// Whether atoms of that predicate say what AtomsOf says; case ignored.
bool IsObservable(const base::Atom& atom);

}  // namespace hires::translation
