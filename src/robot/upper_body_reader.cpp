#include "robot/upper_body_reader.h"

#include <fmt/format.h>

#include "hires/base/text.h"
#include "hires/robot/gripper.h"

namespace hires::robot {
namespace {

using base::Between;
using base::ParamReader;
using base::Positive;

/// Keys in lower case, in the order of the file, with the key as written.
std::vector<std::pair<std::string, std::string>> LowerKeys(const ParamReader& in) {
  std::vector<std::pair<std::string, std::string>> keys;
  for (const std::string& key : in.Keys()) {
    const std::string lower = base::ToLower(key);
    for (const auto& [other, written] : keys) {
      if (other == lower) {
        in.Fail(key, fmt::format("wanted names that differ from '{}' in more than case; rename one",
                                 written));
      }
    }
    keys.emplace_back(lower, key);
  }
  return keys;
}

std::vector<std::string> ReadNames(ParamReader* in, const std::string& key) {
  std::vector<std::string> names = in->GetStrings(key);
  if (names.empty()) in->Fail(key, "wanted at least one name");
  return names;
}

std::vector<std::vector<double>> ReadVariants(ParamReader in, std::size_t num_joints) {
  std::vector<std::vector<double>> variants;
  for (const std::string& key : in.Keys()) variants.push_back(in.GetNumbers(key, num_joints));
  return variants;
}

void ReadPostures(ParamReader in, ArmProfile* arm) {
  for (const auto& [name, key] : LowerKeys(in)) {
    arm->postures[name] = ReadVariants(in.Sub(key), arm->joints.size());
    if (arm->postures[name].empty()) in.Fail(key, "wanted at least one variant");
  }
}

std::map<std::string, std::vector<double>> ReadNamedPositions(ParamReader in,
                                                              std::size_t num_joints) {
  std::map<std::string, std::vector<double>> named;
  for (const auto& [name, key] : LowerKeys(in)) named[name] = in.GetNumbers(key, num_joints);
  return named;
}

ArmProfile ReadArm(ParamReader in) {
  ArmProfile arm;
  arm.joints = ReadNames(&in, "joints");
  arm.tool_link = in.GetString("tool_link");
  arm.palm_link = in.GetString("palm_link");
  arm.gripper_joint = in.GetString("gripper_joint");
  arm.finger_joint = in.GetString("finger_joint");
  arm.left_finger_links = ReadNames(&in, "left_finger_links");
  arm.right_finger_links = ReadNames(&in, "right_finger_links");
  ReadPostures(in.Sub("postures"), &arm);
  arm.holding_postures = ReadNamedPositions(in.Sub("holding_postures"), arm.joints.size());
  arm.way_points = ReadNamedPositions(in.Sub("way_points"), arm.joints.size());
  return arm;
}

FingerShape ReadFingerShape(ParamReader in) {
  FingerShape shape;
  shape.tip_reach = in.Get("tip_reach", Between(0.0, 1.0));
  shape.palm_distance = in.Get("palm_distance", Between(0.0, 1.0));
  shape.pad_half_height = in.Get("pad_half_height", Between(0.0001, 1.0));
  shape.half_height = in.Get("half_height", Between(0.0001, 1.0));
  shape.max_gap_used = in.Get("max_gap_used", Between(0.001, 1.0));
  shape.open_width = in.Get("open_width", Between(0.001, 1.0));
  shape.narrowing = in.Get("narrowing", Between(0.0, 100.0));
  return shape;
}

void ReadSwingingFingers(ParamReader* in, GripperProfile* gripper) {
  gripper->max_finger_angle = in->Get("max_finger_angle", Between(0.01, 1.5));
  gripper->finger_slant = in->Get("finger_slant", Between(-1.5, 1.5));
  // Beyond a right angle the tips would come together again.
  if (gripper->finger_slant + gripper->max_finger_angle > 1.57) {
    in->Fail("finger_slant",
             fmt::format("wanted finger_slant + max_finger_angle at most 1.57, they make {}",
                         gripper->finger_slant + gripper->max_finger_angle));
  }
}

GripperProfile ReadGripper(ParamReader in) {
  GripperProfile gripper;
  gripper.max_gap = in.Get("max_gap", Between(0.001, 1.0));
  gripper.max_speed = in.Get("max_speed", Between(0.001, 10.0));
  gripper.force = in.Get("force", Positive());
  const bool is_sliding =
      in.Has("fingers") && in.Get("fingers", base::OneOf({"swinging", "sliding"})) == "sliding";
  if (is_sliding) {
    gripper.fingers = FingerMotion::kSliding;
    gripper.shape = ReadFingerShape(in.Sub("shape"));  // the default is a PR2's
  } else {
    ReadSwingingFingers(&in, &gripper);
    if (in.Has("shape")) gripper.shape = ReadFingerShape(in.Sub("shape"));
  }
  return gripper;
}

void ReadHead(ParamReader in, UpperBodyProfile* profile) {
  profile->head_pan_joint = in.GetString("pan_joint");
  profile->head_tilt_joint = in.GetString("tilt_joint");
}

void ReadCamera(ParamReader in, UpperBodyProfile* profile) {
  profile->camera_link = in.GetString("link");
  profile->camera_width = in.Get("width", Between(0.01, 3.1));
  profile->camera_height = in.Get("height", Between(0.01, 3.1));
  profile->camera_min_range = in.Get("min_range", Between(0.0, 100.0));
  profile->camera_max_range = in.Get("max_range", Between(0.0, 100.0));
  if (profile->camera_max_range <= profile->camera_min_range) {
    in.Fail("max_range",
            fmt::format("wanted more than min_range, which is {}", profile->camera_min_range));
  }
}

void ReadTorso(ParamReader in, UpperBodyProfile* profile) {
  profile->torso_joint = in.GetString("joint");
  ParamReader postures = in.Sub("postures");
  for (const auto& [name, key] : LowerKeys(postures)) {
    profile->torso_postures[name] = postures.Get(key, Between(-10.0, 10.0));
  }
}

void ReadAccelerations(ParamReader in, UpperBodyProfile* profile) {
  for (const std::string& joint : in.Keys()) {
    profile->accelerations[joint] = in.Get(joint, Between(1e-3, 1e3));
  }
}

const Joint& CheckedJoint(const ParamReader& in, const std::string& key, const RobotModel& model,
                          const std::string& name) {
  const Joint* joint = FindJoint(model, name);
  if (joint == nullptr) {
    in.Fail(key, base::UnknownName("joint", name, model.JointNames()) + " (joints of the URDF)");
  }
  if (joint->type == JointType::kFixed || !joint->mimics.empty()) {
    in.Fail(key, fmt::format("joint '{}' {}; wanted one that can be commanded", name,
                             joint->mimics.empty() ? "is fixed" : "follows " + joint->mimics));
  }
  if (!joint->limits || joint->limits->velocity <= 0.0) {
    in.Fail(key, fmt::format("joint '{}' has no <limit velocity=...> in the URDF; give it one "
                             "above 0, since nothing moves at any speed",
                             name));
  }
  return *joint;
}

void CheckPosition(const ParamReader& in, const std::string& key, const Joint& joint,
                   double position) {
  if (joint.type == JointType::kContinuous) return;
  if (position >= joint.limits->lower && position <= joint.limits->upper) return;
  in.Fail(key, fmt::format("joint '{}' would be at {}, its limits in the URDF are {} to {}",
                           joint.name, position, joint.limits->lower, joint.limits->upper));
}

void CheckBelow(const ParamReader& in, const std::string& key, const RobotModel& model,
                const std::string& link, const std::string& above) {
  CheckLink(in, key, model, link);
  if (IsBelow(model, *model.FindLink(link), *model.FindLink(above))) return;
  in.Fail(key, fmt::format("link '{}' is not carried by '{}'", link, above));
}

/// Each joint carries the next one.  @return the link that the last one carries.
std::string CheckChain(const ParamReader& in, const RobotModel& model,
                       const std::vector<std::string>& joints) {
  std::string last;
  for (const std::string& joint : joints) {
    CheckedJoint(in, "joints", model, joint);
    const std::string link = model.links[*FindLinkOf(model, joint)].name;
    if (!last.empty()) CheckBelow(in, "joints", model, link, last);
    last = link;
  }
  return last;
}

void CheckPosture(const ParamReader& in, const std::string& key, const RobotModel& model,
                  const std::vector<std::string>& joints, const std::vector<double>& positions) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    CheckPosition(in, key, *FindJoint(model, joints[i]), positions[i]);
  }
}

void CheckNamedPositions(const ParamReader& in, const RobotModel& model,
                         const std::vector<std::string>& joints,
                         const std::map<std::string, std::vector<double>>& named) {
  for (const auto& [name, key] : LowerKeys(in)) {
    CheckPosture(in, key, model, joints, named.at(name));
  }
}

void CheckFingers(const ParamReader& in, const std::string& key, const RobotModel& model,
                  const ArmProfile& arm, const std::vector<std::string>& links) {
  for (const std::string& link : links) {
    CheckBelow(in, key, model, link, arm.palm_link);
    if (model.links[*model.FindLink(link)].collisions.empty()) {
      in.Fail(key, fmt::format("link '{}' has no collision shape, so that it touches nothing; add "
                               "one to the URDF or leave it out",
                               link));
    }
  }
}

void CheckGripperJoints(const ParamReader& in, const RobotModel& model, const ArmProfile& arm,
                        const GripperProfile& gripper) {
  const Joint& gap = CheckedJoint(in, "gripper_joint", model, arm.gripper_joint);
  if (gap.type != JointType::kPrismatic) {
    in.Fail("gripper_joint", "wanted a prismatic joint: the gap between the finger tips in m");
  }
  CheckPosition(in, "gripper_joint", gap, gripper.max_gap);
  const Joint& finger = CheckedJoint(in, "finger_joint", model, arm.finger_joint);
  const bool is_sliding = gripper.fingers == FingerMotion::kSliding;
  if (is_sliding != (finger.type == JointType::kPrismatic)) {
    in.Fail("finger_joint", fmt::format("wanted a {} joint for {} fingers (gripper.fingers)",
                                        is_sliding ? "prismatic" : "revolute",
                                        is_sliding ? "sliding" : "swinging"));
  }
  CheckPosition(in, "finger_joint", finger, FingerPositionOf(gripper, gripper.max_gap));
}

void CheckArm(ParamReader in, const RobotModel& model, const ArmProfile& arm,
              const GripperProfile& gripper) {
  const std::string last = CheckChain(in, model, arm.joints);
  CheckBelow(in, "palm_link", model, arm.palm_link, last);
  CheckBelow(in, "tool_link", model, arm.tool_link, last);
  CheckFingers(in, "left_finger_links", model, arm, arm.left_finger_links);
  CheckFingers(in, "right_finger_links", model, arm, arm.right_finger_links);
  CheckGripperJoints(in, model, arm, gripper);
  for (const auto& [name, key] : LowerKeys(in.Sub("postures"))) {
    for (const auto& positions : arm.postures.at(name)) {
      CheckPosture(in.Sub("postures"), key, model, arm.joints, positions);
    }
  }
  CheckNamedPositions(in.Sub("holding_postures"), model, arm.joints, arm.holding_postures);
  CheckNamedPositions(in.Sub("way_points"), model, arm.joints, arm.way_points);
}

void CheckTorso(ParamReader in, const UpperBodyProfile& profile, const RobotModel& model) {
  const Joint& joint = CheckedJoint(in, "joint", model, profile.torso_joint);
  ParamReader postures = in.Sub("postures");
  for (const auto& [name, key] : LowerKeys(postures)) {
    CheckPosition(postures, key, joint, profile.torso_postures.at(name));
  }
}

void Add(base::Hasher* hash, const std::vector<std::string>& names) {
  hash->Add(static_cast<std::uint64_t>(names.size()));
  for (const std::string& name : names) hash->Add(name);
}

void Add(base::Hasher* hash, const std::vector<double>& numbers) {
  hash->Add(static_cast<std::uint64_t>(numbers.size()));
  for (const double number : numbers) hash->Add(number);
}

void Add(base::Hasher* hash, const std::map<std::string, std::vector<double>>& named) {
  hash->Add(static_cast<std::uint64_t>(named.size()));
  for (const auto& [name, positions] : named) {
    hash->Add(name);
    Add(hash, positions);
  }
}

std::vector<double> Numbers(const FingerShape& shape) {
  return {shape.tip_reach,    shape.palm_distance, shape.pad_half_height, shape.half_height,
          shape.max_gap_used, shape.open_width,    shape.narrowing};
}

void Add(base::Hasher* hash, const ArmProfile& arm) {
  Add(hash, arm.joints);
  Add(hash, {arm.tool_link, arm.palm_link, arm.gripper_joint, arm.finger_joint});
  Add(hash, arm.left_finger_links);
  Add(hash, arm.right_finger_links);
  hash->Add(static_cast<std::uint64_t>(arm.postures.size()));
  for (const auto& [name, variants] : arm.postures) {
    hash->Add(name);
    hash->Add(static_cast<std::uint64_t>(variants.size()));
    for (const auto& positions : variants) Add(hash, positions);
  }
  Add(hash, arm.holding_postures);
  Add(hash, arm.way_points);
}

void Add(base::Hasher* hash, const std::map<std::string, double>& numbers) {
  hash->Add(static_cast<std::uint64_t>(numbers.size()));
  for (const auto& [name, number] : numbers) {
    hash->Add(name);
    hash->Add(number);
  }
}

}  // namespace

void CheckLink(const ParamReader& in, const std::string& key, const RobotModel& model,
               const std::string& link) {
  if (model.FindLink(link)) return;
  in.Fail(key, base::UnknownName("link", link, model.LinkNames()) + " (links of the URDF)");
}

UpperBodyProfile ReadUpperBody(ParamReader in) {
  UpperBodyProfile profile;
  ParamReader arms = in.Sub("arms");
  for (const auto& [name, key] : LowerKeys(arms)) profile.arms[name] = ReadArm(arms.Sub(key));
  profile.gripper = ReadGripper(in.Sub("gripper"));
  ReadTorso(in.Sub("torso"), &profile);
  ReadHead(in.Sub("head"), &profile);
  ReadCamera(in.Sub("camera"), &profile);
  ReadAccelerations(in.Sub("accelerations"), &profile);
  profile.default_acceleration = in.Get("default_acceleration", Between(1e-3, 1e3));
  return profile;
}

void CheckUpperBody(ParamReader in, const UpperBodyProfile& profile, const RobotModel& model) {
  ParamReader arms = in.Sub("arms");
  for (const auto& [name, key] : LowerKeys(arms)) {
    if (name == "torso" || name == "head") {
      arms.Fail(key, "wanted another name; torso and head are groups of joints of their own");
    }
    CheckArm(arms.Sub(key), model, profile.arms.at(name), profile.gripper);
  }
  CheckTorso(in.Sub("torso"), profile, model);
  CheckedJoint(in.Sub("head"), "pan_joint", model, profile.head_pan_joint);
  CheckedJoint(in.Sub("head"), "tilt_joint", model, profile.head_tilt_joint);
  CheckLink(in.Sub("camera"), "link", model, profile.camera_link);
  for (const auto& [joint, acceleration] : profile.accelerations) {
    CheckedJoint(in.Sub("accelerations"), joint, model, joint);
  }
}

void AddTo(base::Hasher* hash, const UpperBodyProfile& profile) {
  hash->Add(static_cast<std::uint64_t>(profile.arms.size()));
  for (const auto& [name, arm] : profile.arms) {
    hash->Add(name);
    Add(hash, arm);
  }
  const GripperProfile& gripper = profile.gripper;
  Add(hash, std::vector<double>{gripper.max_gap, gripper.max_finger_angle, gripper.finger_slant,
                                gripper.max_speed, gripper.force});
  // Only then, so that what was measured with a PR2 keeps its hash.
  if (gripper.fingers == FingerMotion::kSliding) hash->Add("sliding");
  if (Numbers(gripper.shape) != Numbers(FingerShape{})) Add(hash, Numbers(gripper.shape));
  Add(hash,
      {profile.torso_joint, profile.head_pan_joint, profile.head_tilt_joint, profile.camera_link});
  Add(hash, profile.torso_postures);
  Add(hash,
      std::vector<double>{profile.camera_width, profile.camera_height, profile.camera_min_range,
                          profile.camera_max_range, profile.default_acceleration});
  Add(hash, profile.accelerations);
}

}  // namespace hires::robot
