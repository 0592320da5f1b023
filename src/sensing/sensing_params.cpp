#include "hires/sensing/sensing_params.h"

#include "hires/base/param_reader.h"

namespace hires::sensing {
namespace {

using base::Between;
using base::ParamReader;

StateParams ReadState(ParamReader in) {
  StateParams params;
  params.stale_after = in.Get("stale_after", Between(0.05, 3.0));
  params.history = in.Get("history", Between(1.0, 100.0));
  params.correction_wait = in.Get("correction_wait", Between(0.0, 1.0));
  params.posture_reach = in.Get("posture_reach", Between(0.001, 1.0));
  return params;
}

MemoryParams ReadMemory(ParamReader in) {
  MemoryParams params;
  params.expected_share = in.Get("expected_share", Between(0.05, 1.0));
  params.expected_size = in.Get("expected_size", Between(0.0, 1.0));
  params.expected_distance = in.Get("expected_distance", Between(0.1, 100.0));
  params.expected_margin = in.Get("expected_margin", Between(0.0, 0.5));
  params.looks_to_vanish = in.Get("looks_to_vanish", Between(1, 1000));
  params.blending = in.Get("blending", Between(0.01, 1.0));
  params.moved_distance = in.Get("moved_distance", Between(0.0, 1.0));
  params.moved_angle = in.Get("moved_angle", Between(0.0, 3.2));
  params.grasp_distance = in.Get("grasp_distance", Between(0.0, 0.5));
  params.closed_gap = in.Get("closed_gap", Between(0.0, 0.05));
  params.gap_below = in.Get("gap_below", Between(0.0, 0.1));
  params.gap_above = in.Get("gap_above", Between(0.0, 0.1));
  params.open_gap = in.Get("open_gap", Between(0.0, 0.05));
  params.opening = in.Get("opening", Between(0.0, 0.05));
  params.still_gap = in.Get("still_gap", Between(0.0001, 0.02));
  params.still_time = in.Get("still_time", Between(0.0, 5.0));
  params.hand_distance = in.Get("hand_distance", Between(0.01, 1.0));
  params.instance_distance = in.Get("instance_distance", Between(0.0, 1.0));
  params.told_distance = in.Get("told_distance", Between(0.0, 10.0));
  params.instance_margin = in.Get("instance_margin", Between(0.0, 1.0));
  params.looks_to_appear = in.Get("looks_to_appear", Between(1, 1000));
  params.scans_to_vanish = in.Get("scans_to_vanish", Between(1, 1000));
  params.scans_to_appear = in.Get("scans_to_appear", Between(1, 1000));
  return params;
}

}  // namespace

SensingParams ReadSensingParams(ParamReader in) {
  return {ReadState(in.Sub("robot_state")), ReadMemory(in.Sub("memory")),
          ReadGroundWatchParams(in.Sub("ground"))};
}

}  // namespace hires::sensing
