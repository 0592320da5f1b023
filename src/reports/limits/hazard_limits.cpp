#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "hires/imagination/start_state.h"
#include "imagination/hazards.h"
#include "reports/limits/motion_limits.h"
#include "simulation/floor/robot_balance.h"

namespace hires::reports {

double HazardLimits::MostAcceleration() const {
  double most = std::numeric_limits<double>::infinity();
  for (const MotionBounds& bound : bounds)
    if (bound.unit == "m/s^2") most = std::min(most, bound.closed_form);
  return most;
}

namespace {

void AddLiquid(const std::string& object, const imagination::ImaginationSetup& setup,
               HazardLimits* hazards) {
  const simulation::Scene& scene = *setup.scene;
  const double gravity = scene.world.gravity;
  const auto model = scene.world.RequireModel(setup.ModelOf(object));
  if (model->liquid) {
    hazards->bounds.push_back(
        {"liquid reaches rim", "m/s^2",
         scene.robot.profile.base_controller.limits.max_linear_acceleration,
         imagination::SpillingAcceleration(*model->liquid, gravity),
         fmt::format("sudden start, a slow one bears twice that; first sloshing mode {:.2f} Hz",
                     physics::SloshFrequency(model->liquid->radius, model->liquid->fill, gravity) /
                         (2.0 * M_PI))});
  } else if (!imagination::UnknownLiquidText(object, *model).empty()) {
    hazards->left_out.push_back("liquids that slosh");
  }
}

}  // namespace

HazardLimits FindHazardLimits(const std::vector<std::string>& objects,
                              const imagination::ImaginationSetup& setup) {
  const simulation::Scene& scene = *setup.scene;
  const robot::BaseControllerParams& controller = scene.robot.profile.base_controller;
  const robot::MotionSet& own = controller.limits;
  const double gravity = scene.world.gravity;
  HazardLimits hazards;
  std::vector<geometry::MassProperties> payloads_B;  // the base is at the map's origin
  for (const world::ObjectState& object :
       imagination::StartOnTray(setup, {}, objects).world.objects)
    payloads_B.push_back(
        geometry::InFrame(object.X_MO, scene.world.RequireModel(object.model)->mass_properties));
  const auto balance =
      simulation::BalanceOf(scene.robot, scene.robot.profile.joints, payloads_B, gravity);
  if (balance) {
    const bool has_two_axes = controller.drive == robot::Drive::kOmnidirectional;
    for (const auto& [motion, sign] : {std::pair("acceleration", 1.0), {"deceleration", -1.0}}) {
      const double bears = has_two_axes ? balance->TippingAcceleration(controller.drive)
                                        : balance->TippingAcceleration({sign, 0.0});
      const std::string support = balance->support.is_assumed ? ", ASSUMED on its footprint" : "";
      hazards.bounds.push_back({std::string("robot tips, ") + motion, "m/s^2",
                                own.max_linear_acceleration, bears,
                                balance->Text(bears) + support});
    }
    const double sideways = balance->SidewaysTippingAcceleration();
    hazards.bounds.push_back({"robot tips, turning", "rad/s", own.max_angular_velocity,
                              sideways / own.max_linear_velocity,
                              fmt::format("an arc at {:g} m/s; sideways it tips from {:.2f} m/s^2",
                                          own.max_linear_velocity, sideways)});
  } else {
    hazards.left_out.push_back("whether the robot itself tips over (its URDF gives no masses)");
  }
  for (const std::string& object : objects) AddLiquid(object, setup, &hazards);
  return hazards;
}

}  // namespace hires::reports
