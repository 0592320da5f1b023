#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <hires/GenerateImagineState.h>
#include <ros/node_handle.h>

#include <string>

#include "hires/ros/knowledge/remote_view.h"
#include "hires/translation/translator.h"

namespace hires_ros {

/// Answers generate_imagine_state: the state that atoms speak of, in metres and radians, with what
/// the Blackboard knows of poses.
class TranslatorNode {
 public:
  /// @param map_frame  tf's name of the frame in which the answers are.
  TranslatorNode(hires::translation::TranslatorContext context, const std::string& map_frame,
                 ros::NodeHandle* nh);

  /// @throws hires::base::ConfigError naming the atom, or saying that the Blackboard is missing.
  hires::translation::GeometricState StateFor(const std::vector<hires::base::Atom>& atoms,
                                              bool is_whole_state);

 private:
  using Request = hires::GenerateImagineState::Request;
  using Response = hires::GenerateImagineState::Response;

  bool OnRequest(Request& request, Response& response);
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const hires::translation::TranslatorContext context_;
  const std::string map_frame_;
  RemoteView view_;
  int num_answered_{0}, num_refused_{0};
  ros::ServiceServer server_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
};

/// The atoms of a view with some changed: what is put somewhere is held no more, what is taken up
/// is on nothing any more, unless `changes` say so themselves.
/// @throws hires::base::ConfigError naming the atom.
std::vector<hires::base::Atom> AtomsWith(const hires::knowledge::FluentView& view,
                                         const hires::knowledge::Ontology& ontology,
                                         const std::vector<hires::base::Atom>& changes);

}  // namespace hires_ros
