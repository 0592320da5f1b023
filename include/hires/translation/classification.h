#pragma once

#include <vector>

#include "hires/base/action.h"
#include "hires/translation/translator.h"

namespace hires::translation {

/// Geometry to symbols: RobotAt (the nearest area within tolerance, else the room that the robot is
/// in), HasArmPosture (`armunnamedposture` where none fits), HasTorsoPosture (`torsoposture`
/// likewise), Holding (`nothing` for an empty hand), On (placing areas and the tray; an object that
/// lies, is held or stands elsewhere has none; where areas overlap, the one whose middle is
/// nearest). A robot without an upper body has no postures and no hands. As knowledge::StateAtoms
/// sorts and spells them.
/// @param before  what held before, null: nothing. Noise at a border does not change it.
/// @throws base::ConfigError as robot::ForwardKinematics, for joints.
std::vector<base::Atom> AtomsOf(const TranslatorContext& context, const GeometricState& state,
                                const std::vector<base::Atom>* before = nullptr);

/// Whether atoms of that predicate say what AtomsOf says; case ignored.
bool IsObservable(const base::Atom& atom);

}  // namespace hires::translation
