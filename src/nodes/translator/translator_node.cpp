#include "nodes/translator/translator_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/knowledge/state_view.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/robot/robot_state_messages.h"
#include "hires/ros/world/world_messages.h"
#include "hires/translation/classification.h"

namespace hires_ros {
namespace {

namespace knowledge = hires::knowledge;
namespace translation = hires::translation;
using hires::base::Atom;
using hires::base::ConfigError;
using hires::base::Log;
using hires::base::LogLevel;
using hires::base::ToLower;

bool IsOf(const Atom& atom, const char* predicate) {
  return ToLower(atom.predicate) == predicate && atom.arguments.size() == 2;
}

bool Mentions(const std::vector<Atom>& atoms, const char* predicate, std::size_t argument,
              const std::string& value) {
  return std::any_of(atoms.begin(), atoms.end(), [&](const Atom& atom) {
    return IsOf(atom, predicate) && ToLower(atom.arguments[argument]) == ToLower(value);
  });
}

/// What follows for On and Holding from a change of the other one.
void FollowFrom(const Atom& change, const std::vector<Atom>& changes,
                const std::vector<Atom>& before, knowledge::ProjectedView* view) {
  for (const Atom& old : before) {
    if (IsOf(change, "holding") && IsOf(old, "on") &&
        ToLower(change.arguments[1]) == old.arguments[0] &&
        !Mentions(changes, "on", 0, old.arguments[0])) {
      view->Delete(old);
    }
    if (IsOf(change, "on") && IsOf(old, "holding") &&
        ToLower(change.arguments[0]) == old.arguments[1] &&
        !Mentions(changes, "holding", 0, old.arguments[0])) {
      view->Add({"Holding", {old.arguments[0], "nothing"}});
    }
  }
}

std::vector<hires::Posture> PosturesOf(const translation::TranslatorContext& context,
                                       const translation::GeometricState& state) {
  std::vector<hires::Posture> postures;
  for (const Atom& atom : translation::AtomsOf(context, state)) {
    hires::Posture posture;
    posture.value = atom.arguments.back();
    if (atom.predicate == "HasArmPosture") posture.name = atom.arguments.front();
    if (atom.predicate == "HasTorsoPosture") posture.name = "torso";
    if (!posture.name.empty()) postures.push_back(posture);
  }
  return postures;
}

void RequireNames(const Atom& atom) {
  const bool is_empty =
      atom.predicate.empty() || std::any_of(atom.arguments.begin(), atom.arguments.end(),
                                            [](const std::string& name) { return name.empty(); });
  if (!is_empty) return;
  throw ConfigError(fmt::format("updated_fluents: {} has an empty predicate or argument",
                                hires::base::ToString(atom)));
}

}  // namespace

std::vector<Atom> AtomsWith(const knowledge::FluentView& view, const knowledge::Ontology& ontology,
                            const std::vector<Atom>& changes) {
  const auto before = knowledge::StateAtoms(view, ontology);
  knowledge::ProjectedView projected(&view, &ontology);
  for (const Atom& change : changes) {
    FollowFrom(change, changes, before, &projected);
    projected.Add(change);
  }
  return knowledge::StateAtoms(projected, ontology);
}

TranslatorNode::TranslatorNode(translation::TranslatorContext context, const std::string& map_frame,
                               ros::NodeHandle* nh)
    : context_(std::move(context)), map_frame_(map_frame), view_(*nh) {
  updater_.setHardwareID("translator");
  updater_.add("translator", this, &TranslatorNode::Diagnose);
  timer_ = nh->createSteadyTimer(ros::WallDuration(1.0),
                                 [this](const ros::SteadyTimerEvent&) { updater_.update(); });
  server_ = nh->advertiseService(kGenerateImagineState, &TranslatorNode::OnRequest, this);
  Log(LogLevel::kInfo, fmt::format("world={} robot={} areas={} objects={}", context_.world->name,
                                   context_.robot->model.name, context_.areas.all.size(),
                                   context_.object_models.size()));
}

translation::GeometricState TranslatorNode::StateFor(const std::vector<Atom>& atoms,
                                                     bool is_whole_state) {
  for (const Atom& atom : atoms) RequireNames(atom);
  const bool is_up_to_date = view_.CatchUp();
  if (!is_up_to_date && !view_.is_known() && !is_whole_state) {
    throw ConfigError(
        fmt::format("the Blackboard does not answer at '{}', and its atoms are "
                    "wanted; start it, or send the whole state",
                    kBlackboard));
  }
  if (!is_up_to_date) {
    Log(LogLevel::kWarn, "blackboard=away poses are those that were known last");
  }
  return view_.Read([&](const knowledge::FluentView& view) {
    return translation::StateOf(
        translation::WithKnowledge(context_, view), &view,
        is_whole_state ? atoms : AtomsWith(view, *context_.ontology, atoms));
  });
}

bool TranslatorNode::OnRequest(Request& request, Response& response) {
  std::vector<Atom> atoms;
  for (const auto& atom : request.updated_fluents) {
    atoms.push_back({atom.predicate, atom.arguments});
  }
  try {
    const auto state = StateFor(atoms, request.is_whole_state);
    response.world_state = ToMsg(state.world);
    response.world_state.header.stamp = ros::Time::now();
    response.world_state.header.frame_id = map_frame_;
    response.robot_state = ToMsg(state.robot);
    response.robot_state.postures = PosturesOf(context_, state);
    ++num_answered_;
  } catch (const ConfigError& error) {
    response.error = error.what();
    ++num_refused_;
    Log(LogLevel::kWarn, fmt::format("request=refused why={}", error.what()));
  }
  return true;  // also a refusal is an answer
}

void TranslatorNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (view_.is_connected()) {
    status.summary(DiagnosticStatus::OK, "ready");
  } else {
    status.summary(DiagnosticStatus::WARN,
                   view_.is_known() ? "the Blackboard is away" : "waits for the Blackboard");
  }
  status.add("requests answered", num_answered_);
  status.add("requests refused", num_refused_);
  status.add("blackboard sequence", view_.sequence());
}

}  // namespace hires_ros
