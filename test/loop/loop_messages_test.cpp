#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "hires/base/text.h"
#include "loop/task_loop.h"
#include "reports/task/timeline.h"
#include "support/temporary_folder.h"

// Messages that are late or lost on their way between the parts of the loop.
namespace hires::loop::loop_messages_test {
namespace {

const std::string kConfig = HIRES_SOURCE_DIR "/config/";

/// A file of this name that is gone with the program.
std::string Written(const std::string& name, const std::string& text) {
  static const test_support::TemporaryFolder folder;
  return folder.Write(name, text);
}

/// config/loop.yaml with other messages.
std::string LoopWith(const std::string& messages) {
  std::string text;
  for (const std::string& line : base::Split(base::ReadTextFile(kConfig + "loop.yaml"), '\n')) {
    const std::size_t colon = line.find(": ");
    const bool is_kind = line.rfind("  ", 0) == 0 && line.find("delay:") != std::string::npos;
    const bool names_file = line.find(".yaml", std::min(colon, line.size())) != std::string::npos;
    if (is_kind || line[0] == '#') continue;
    if (line.rfind("messages:", 0) == 0) {
      text += "messages: " + messages;
    } else if ((names_file || line.rfind("truths:", 0) == 0) && line[0] != ' ') {
      text += line.substr(0, colon + 2) + kConfig + line.substr(colon + 2);
    } else {
      text += line;
    }
    text += '\n';
  }
  return Written("loop.yaml", text);
}

/// A mug is to come from the counter onto the tray.
LoopOrder LoadTray() {
  LoopOrder order;
  order.scenario = Written("scenario.yaml", "task: load_tray mug1 counter1\nknowledge: [" +
                                                kConfig + "knowledge/restaurant.yaml]\n" + R"(
robot:
  pose: [6.8, 10.1, 3.14]
  torso: torsoupposture
  arms: {leftarm1: armtuckedposture, rightarm1: armtosideposture}
objects:
  - {name: mug1, pose: [5.37, 10.26, 0.75, 0.0]}
hidden: []
)");
  order.imagination = "off";
  return order;
}

std::string Bits(const LoopRun& run) {
  nlohmann::ordered_json json = reports::ToJson(run.report);
  json["seconds"] = run.virtual_seconds;
  return json.dump();
}

TEST(LoopMessagesTest, ATaskIsDoneThoughMessagesAreLateAndLostAndTheSameEachTime) {
  const LoopSetup bad(
      LoopWith("{sensors: {delay: 0.01, jitter: 0.03, loss: 0.2}, looks: {delay: 0.01, jitter: "
               "0.01, loss: 0.5}, actions: {delay: 0.02, jitter: 0.1}, blackboard: {delay: 0.02, "
               "jitter: 0.1}}"));
  const LoopRun run = PlayTask(bad, LoadTray());
  EXPECT_EQ(run.report.outcome, AchieveOutcome::kSucceeded) << run.report.reason;
  EXPECT_EQ(Bits(PlayTask(bad, LoadTray())), Bits(run));
  const LoopSetup good(kConfig + "loop.yaml");
  const LoopRun undisturbed = PlayTask(good, LoadTray());
  EXPECT_EQ(undisturbed.report.outcome, AchieveOutcome::kSucceeded) << undisturbed.report.reason;
  EXPECT_LT(undisturbed.virtual_seconds, run.virtual_seconds) << "late messages take time";
}

}  // namespace
}  // namespace hires::loop::loop_messages_test
