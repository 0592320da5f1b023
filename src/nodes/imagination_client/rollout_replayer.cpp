#include "nodes/imagination_client/rollout_replayer.h"

#include <fmt/format.h>

#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/short_text.h"
#include "hires/base/text.h"
#include "hires/imagination/rollout_choice.h"
#include "hires/imagination/rollout_recording.h"
#include "hires/ros/imagination/rollout_bag.h"
#include "hires/ros/names/topic_names.h"

namespace hires_ros {
namespace {

namespace imagination = hires::imagination;
using hires::base::ConfigError;

constexpr std::size_t kMostKept = 8;

}  // namespace

RolloutReplayer::RolloutReplayer(std::string folder, ros::NodeHandle* nh)
    : folder_(std::move(folder)), started_(ros::WallTime::now().sec), spinner_(1, &queue_) {
  ros::AdvertiseServiceOptions options =
      ros::AdvertiseServiceOptions::create<hires::ImaginedRollout>(
          kImaginedRollout,
          [this](Request& request, Response& response) { return OnRequest(request, response); }, {},
          &queue_);
  server_ = nh->advertiseService(options);
  spinner_.start();
}

RolloutReplayer::~RolloutReplayer() {
  is_stopping_ = true;
  server_.shutdown();
  spinner_.stop();
}

void RolloutReplayer::Keep(AnsweredRequest answered) {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_.push_front(std::make_shared<const AnsweredRequest>(std::move(answered)));
  if (last_.size() > kMostKept) last_.pop_back();
}

std::shared_ptr<const AnsweredRequest> RolloutReplayer::Find(const std::string& id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> known;
  for (const auto& answered : last_) {
    if (id.empty() || answered->id == id) return answered;
    known.push_back(answered->id);
  }
  if (last_.empty()) throw ConfigError("no request was answered yet; send one to the action first");
  throw ConfigError(fmt::format("{}; of older ones nothing is kept",
                                hires::base::UnknownName("request_id", id, known)));
}

std::string RolloutReplayer::PathFor(const AnsweredRequest& answered, int rank, int index) const {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw ConfigError(
        fmt::format("{}: cannot be made ({}); set ~rollout_folder", folder_, error.message()));
  }
  // Requests are counted anew by each start of the node: nobody's earlier bag is written over.
  return fmt::format("{}/{}_request_{}_prediction_{}_rollout_{}.bag", folder_, started_,
                     answered.number, rank, index);
}

bool RolloutReplayer::OnRequest(Request& request, Response& response) {
  try {
    Answer(request, &response);
  } catch (const std::exception& error) {  // one bad request must not end the node
    response = Response();
    response.message = hires::base::Shortened(error.what());
  }
  return true;
}

void RolloutReplayer::Answer(const Request& request, Response* response) {
  const imagination::RolloutChoice choice = imagination::ParseRolloutChoice(request.which);
  const auto answered = Find(request.request_id);
  const imagination::RolloutSetup& setup = answered->request->setup;
  const auto cancelled = [this] { return is_stopping_.load(); };
  const auto picked =
      imagination::PickRollout(choice, answered->ranking, imagination::TiltsIn(setup));
  const imagination::Prediction& prediction = answered->ranking[picked.rank - 1];
  response->path = PathFor(*answered, picked.rank, picked.index);
  const auto bag = MakeRolloutBag(response->path, setup);
  const auto recording =
      imagination::ReplayRollout(setup, prediction, picked.index, cancelled, bag.get());
  if (!recording) throw ConfigError("the imagination client is going down");
  bag->Save(*recording);
  response->rollout = answered->predictions.at(picked.rank - 1).worst;
  response->rollout.index = picked.index;
  for (const imagination::RolloutEvent& event : recording->events) {
    response->times.push_back(event.time);
    response->events.push_back(event.text);
  }
  response->success = true;
}

}  // namespace hires_ros
