#include "hires/translation/translator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "hires/robot/gripper.h"
#include "hires/translation/classification.h"
#include "hires/world/unknown_box.h"
#include "translation/arrangement.h"
#include "translation/body.h"
#include "translation/stated_pose.h"
#include "translation/wanted_state.h"

namespace hires::translation {
namespace {

/// "mug" of "mug12".
std::string WithoutNumber(const std::string& instance) {
  std::size_t end = instance.size();
  while (end > 0 && std::isdigit(static_cast<unsigned char>(instance[end - 1]))) --end;
  return instance.substr(0, end);
}

/// Where the robot was seen, if its Pose is on the Blackboard.
std::optional<geometry::Pose2> SeenRobot(const TranslatorContext& context,
                                         const knowledge::FluentView* fluents) {
  if (fluents == nullptr || context.ontology == nullptr) return std::nullopt;
  const auto robot = context.ontology->Find("Robot");
  if (robot == knowledge::Ontology::kUnknown) return std::nullopt;
  std::optional<geometry::Pose2> seen;
  for (const auto below : context.ontology->Below(robot)) {
    fluents->OfConcept(context.ontology->Name(below), [&](const knowledge::Fluent& fluent) {
      const auto stated = PoseStatedBy(*fluents, fluent);
      if (stated && stated->frame.empty()) seen = geometry::Flatten(stated->X_FO);
      return !seen;
    });
    if (seen) break;
  }
  return seen;
}

/// Where a robot that stands there is said to be.
std::string AreaAt(const TranslatorContext& context, const geometry::Pose2& X_MB) {
  GeometricState there;
  there.robot.X_MB = X_MB;
  for (const base::Atom& atom : AtomsOf(context, there)) {
    if (atom.predicate == "RobotAt") return atom.arguments[0];
  }
  return "";
}

bool IsWithin(const Area& area, const geometry::Pose2& X_MB) {
  const Eigen::Vector2d p_A = geometry::Flatten(area.X_FA).Inverse() * X_MB.position();
  return (p_A.cwiseAbs().array() <= area.size.array() / 2).all();
}

/// The middle of a room may happen to be an area to stand at, but not in every direction.
/// @throws base::ConfigError for the floor of a world without rooms, which has none
geometry::Pose2 MiddleOf(const TranslatorContext& context, const Area& area) {
  if (area.name == kFloorArea && context.world->frames.count(area.name) == 0) {
    throw base::ConfigError(fmt::format(
        "RobotAt({}): nothing says where on the floor; wanted the robot's pose on the Blackboard "
        "(hasPose), or an area's name",
        kFloorArea));
  }
  const geometry::Pose2 X_MA = geometry::Flatten(area.X_FA);
  for (int quarter = 0; quarter < 4; ++quarter) {
    const geometry::Pose2 X_MB{X_MA.x, X_MA.y,
                               geometry::WrapToPi(X_MA.yaw + quarter * geometry::kPi / 2)};
    if (area.kind != AreaKind::kRoom || AreaAt(context, X_MB) == area.name) return X_MB;
  }
  return X_MA;
}

geometry::Pose2 BaseAt(const TranslatorContext& context, const knowledge::FluentView* fluents,
                       const std::string& name) {
  const Area& area = context.areas.Require(name);
  const auto seen = SeenRobot(context, fluents);
  if (!seen) return MiddleOf(context, area);
  const bool may_be_there =
      AreaAt(context, *seen) == name || (area.kind == AreaKind::kRoom && IsWithin(area, *seen));
  return may_be_there ? *seen : MiddleOf(context, area);
}

bool Holds(const WantedState& wanted, const std::string& arm) {
  return std::any_of(wanted.holders.begin(), wanted.holders.end(),
                     [&](const auto& held) { return held.second == arm; });
}

robot::JointPositions JointsFor(const TranslatorContext& context, const WantedState& wanted) {
  const robot::Robot& robot = *context.robot;
  robot::JointPositions joints = robot.profile.joints;
  if (!robot.profile.upper_body) return joints;
  const robot::UpperBodyProfile& body = *robot.profile.upper_body;
  for (const auto& [name, posture] : wanted.arm_postures) {
    const robot::ArmProfile& arm = body.arms.at(name);
    const auto positions = ArmJointsFor(robot, arm, posture, Holds(wanted, name));
    for (std::size_t i = 0; i < arm.joints.size(); ++i) joints[arm.joints[i]] = (*positions)[i];
  }
  if (!wanted.torso_posture.empty()) {
    joints[body.torso_joint] = *TorsoHeightFor(body, wanted.torso_posture);
  }
  return joints;
}

/// Grippers that hold something are as far open as that is wide.
void CloseGrippers(const TranslatorContext& context, const WantedState& wanted,
                   const world::WorldState& world, robot::JointPositions* joints) {
  if (!context.robot->profile.upper_body) return;
  const robot::UpperBodyProfile& body = *context.robot->profile.upper_body;
  for (const auto& [object, name] : wanted.holders) {
    const world::ObjectState* held = world.Find(object);
    const double width = WidthOf(*context.world->RequireModel(held->model));
    robot::SetGap(body.gripper, body.arms.at(name), width, joints);
  }
  robot::CompleteGrippers(body, joints);
}

/// Things of unknown kind are as large as fluents say. One whose box is not told, or is none, stays
/// without a model.
void AddUnknownThings(const knowledge::FluentView& view, TranslatorContext* context) {
  if (context->ontology->Find(kUnknownConcept) == knowledge::Ontology::kUnknown) return;
  view.OfConcept(kUnknownConcept, [&](const knowledge::Fluent& thing) {
    const knowledge::Fluent* box = view.Find(LinkOf(thing, "hasBoundingBox"));
    if (box == nullptr) return true;
    const auto x = NumberOf(*box, "hasXSize"), y = NumberOf(*box, "hasYSize"),
               z = NumberOf(*box, "hasZSize");
    if (!x || !y || !z) return true;
    try {
      context->object_models[base::ToLower(thing.instance)] = world::UnknownBoxModel({*x, *y, *z});
    } catch (const base::ConfigError&) {  // no size that a box can have
    }
    return true;
  });
}

}  // namespace

std::string TranslatorContext::FindModel(const std::string& instance) const {
  const std::string lower = base::ToLower(instance);
  const auto own = object_models.find(lower);
  if (own != object_models.end()) return own->second;
  const std::string kind = WithoutNumber(lower);
  for (const auto& [name, model] : object_models) {
    if (world::SaysUnknownBox(model)) continue;  // what is unknown is like nothing else
    if (WithoutNumber(name) == kind) return model;
  }
  for (const std::string& said : {lower, kind}) {  // a newcomer is called by its kind: coke_can1
    for (const auto& [name, model] : world->models) {
      if (base::ToLower(name) == said) return name;
    }
  }
  return "";
}

std::string TranslatorContext::ModelOf(const std::string& instance) const {
  const std::string model = FindModel(instance);
  if (!model.empty()) return model;
  if (instance.find_first_of("./") != std::string::npos) {
    throw base::ConfigError(
        fmt::format("object '{}' is a file: running nodes know what their catalogue names; put its "
                    "model there, "
                    "or imagine without nodes: `hires imagine --local --object {}`, or "
                    "hires.core.Scene in Python",
                    instance, instance));
  }
  std::vector<std::string> known;
  for (const auto& [name, unused] : object_models) known.push_back(name);
  throw base::ConfigError(base::UnknownName("object", instance, known) +
                          "; name its model in the catalogue of objects");
}

TranslatorContext WithKnowledge(TranslatorContext context, const knowledge::FluentView& view) {
  context.areas = WithKnowledge(std::move(context.areas), view, *context.ontology);
  AddUnknownThings(view, &context);
  return context;
}

TranslatorContext MakeContext(
    world::World world, robot::Robot robot,
    const std::map<std::string, std::shared_ptr<const world::ObjectModel>>& catalogue,
    std::shared_ptr<const knowledge::Ontology> ontology) {
  TranslatorContext context;
  for (const auto& [instance, model] : catalogue) {
    context.object_models[base::ToLower(instance)] = model->name;
    world.models[model->name] = model;
  }
  world.hash = world.ComputeHash();
  context.areas = AreasOf(world, robot);
  context.world = std::make_shared<const world::World>(std::move(world));
  context.robot = std::make_shared<const robot::Robot>(std::move(robot));
  context.ontology = std::move(ontology);
  return context;
}

GeometricState StateOf(const TranslatorContext& context, const knowledge::FluentView* fluents,
                       const std::vector<base::Atom>& atoms) {
  const WantedState wanted = ReadWanted(context, atoms);
  GeometricState state;
  state.robot.X_MB = BaseAt(context, fluents, wanted.robot_area);
  state.robot.joints = JointsFor(context, wanted);
  const Body body(*context.robot, state.robot);
  state.world = Arrange(context, fluents, wanted, body);
  CloseGrippers(context, wanted, state.world, &state.robot.joints);
  return state;
}

}  // namespace hires::translation
