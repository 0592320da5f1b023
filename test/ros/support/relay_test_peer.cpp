// A small node that plays one part in the tests and the benchmark of relay and worker_host, and
// tells on standard output, one line each, what happened to it.
//
//   relay_test_peer stream <topic> <rate>       numbers, published at <rate> [Hz]
//   relay_test_peer latch <topic> <text>        one latched text
//   relay_test_peer clock                       /clock at 10 Hz
//   relay_test_peer count <topic>               "received=.. lost=.. last=..", ten times a second
//   relay_test_peer hear <topic>                "heard=<text>" for each text
//   relay_test_peer echo <in> <out>             sends texts back
//   relay_test_peer pingpong <out> <in> <n> <bytes>   "rtt_us=.." for each of n round trips
//   relay_test_peer serve <service>             answers its node name
//   relay_test_peer call <service>              "reply=.."
//   relay_test_peer worker <namespace>          action <namespace>/rollout, topic <namespace>/state
//   relay_test_peer goal <namespace> <n> <cancel after>   "feedback=.." and "state=.. code=.."

#include <actionlib/client/simple_action_client.h>
#include <actionlib/server/simple_action_server.h>
#include <hires/RolloutAction.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt64.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace {

using Arguments = std::vector<std::string>;
constexpr int kQueue = 100000;

int Stream(ros::NodeHandle& nh, const Arguments& arguments) {
  ros::Publisher publisher = nh.advertise<std_msgs::UInt64>(arguments.at(0), kQueue);
  std_msgs::UInt64 number;
  const ros::WallTimerCallback send = [&](const ros::WallTimerEvent&) {
    publisher.publish(number);
    ++number.data;
  };
  const auto timer = nh.createWallTimer(ros::WallDuration(1.0 / std::stod(arguments.at(1))), send);
  ros::spin();
  return 0;
}

int Latch(ros::NodeHandle& nh, const Arguments& arguments) {
  ros::Publisher publisher = nh.advertise<std_msgs::String>(arguments.at(0), 1, true);
  std_msgs::String text;
  text.data = arguments.at(1);
  publisher.publish(text);
  ros::spin();
  return 0;
}

int Clock(ros::NodeHandle& nh, const Arguments&) {
  ros::Publisher publisher = nh.advertise<rosgraph_msgs::Clock>("/clock", 10);
  const ros::WallTimerCallback send = [&](const ros::WallTimerEvent&) {
    publisher.publish(rosgraph_msgs::Clock());
  };
  const auto timer = nh.createWallTimer(ros::WallDuration(0.1), send);
  ros::spin();
  return 0;
}

struct Counts {
  std::uint64_t received{0};
  std::uint64_t lost{0};
  std::uint64_t last{0};

  void Add(std::uint64_t number) {
    if (received > 0 && number != last + 1) lost += number > last ? number - last - 1 : 1;
    last = number;
    ++received;
  }
};

int Count(ros::NodeHandle& nh, const Arguments& arguments) {
  Counts counts;
  const boost::function<void(const std_msgs::UInt64ConstPtr&)> add =
      [&](const std_msgs::UInt64ConstPtr& number) { counts.Add(number->data); };
  const ros::Subscriber subscriber = nh.subscribe<std_msgs::UInt64>(
      arguments.at(0), kQueue, add, nullptr, ros::TransportHints().tcpNoDelay());
  const ros::WallTimerCallback tell = [&](const ros::WallTimerEvent&) {
    std::cout << "received=" << counts.received << " lost=" << counts.lost
              << " last=" << counts.last << std::endl;
  };
  const auto timer = nh.createWallTimer(ros::WallDuration(0.1), tell);
  ros::spin();
  return 0;
}

int Hear(ros::NodeHandle& nh, const Arguments& arguments) {
  const boost::function<void(const std_msgs::StringConstPtr&)> tell =
      [](const std_msgs::StringConstPtr& text) {
        std::cout << "heard=" << text->data << std::endl;
      };
  const ros::Subscriber subscriber = nh.subscribe<std_msgs::String>(arguments.at(0), kQueue, tell);
  ros::spin();
  return 0;
}

int Echo(ros::NodeHandle& nh, const Arguments& arguments) {
  ros::Publisher publisher = nh.advertise<std_msgs::String>(arguments.at(1), kQueue);
  const boost::function<void(const std_msgs::StringConstPtr&)> send_back =
      [&](const std_msgs::StringConstPtr& text) { publisher.publish(text); };
  const ros::Subscriber subscriber = nh.subscribe<std_msgs::String>(
      arguments.at(0), kQueue, send_back, nullptr, ros::TransportHints().tcpNoDelay());
  ros::spin();
  return 0;
}

int PingPong(ros::NodeHandle& nh, const Arguments& arguments) {
  using SteadyClock = std::chrono::steady_clock;
  ros::Publisher publisher = nh.advertise<std_msgs::String>(arguments.at(0), kQueue);
  int left = std::stoi(arguments.at(2));
  std_msgs::String text;
  text.data.assign(std::stoul(arguments.at(3)), 'x');
  SteadyClock::time_point sent;
  const boost::function<void(const std_msgs::StringConstPtr&)> take =
      [&](const std_msgs::StringConstPtr&) {
        const std::chrono::duration<double, std::micro> rtt = SteadyClock::now() - sent;
        std::cout << "rtt_us=" << rtt.count() << '\n';
        if (--left == 0) return ros::requestShutdown();
        sent = SteadyClock::now();
        publisher.publish(text);
      };
  const ros::Subscriber subscriber = nh.subscribe<std_msgs::String>(
      arguments.at(1), kQueue, take, nullptr, ros::TransportHints().tcpNoDelay());
  while (ros::ok() && (publisher.getNumSubscribers() == 0 || subscriber.getNumPublishers() == 0)) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  sent = SteadyClock::now();
  publisher.publish(text);
  ros::spin();
  std::cout.flush();
  return 0;
}

int Serve(ros::NodeHandle& nh, const Arguments& arguments) {
  using Trigger = std_srvs::Trigger;
  const boost::function<bool(Trigger::Request&, Trigger::Response&)> answer =
      [](Trigger::Request&, Trigger::Response& response) {
        response.success = true;
        response.message = ros::this_node::getName();
        return true;
      };
  const ros::ServiceServer server = nh.advertiseService(arguments.at(0), answer);
  ros::spin();
  return 0;
}

int Call(ros::NodeHandle&, const Arguments& arguments) {
  ros::service::waitForService(arguments.at(0));
  std_srvs::Trigger call;
  const bool is_done = ros::service::call(arguments.at(0), call);
  std::cout << "reply=" << (is_done ? call.response.message : "failed") << std::endl;
  return is_done ? 0 : 1;
}

using Server = actionlib::SimpleActionServer<hires::RolloutAction>;

void Play(const hires::RolloutGoalConstPtr& goal, Server* server) {
  hires::RolloutResult result;
  ros::WallRate pace(100.0);
  for (std::uint32_t i = 0; i < goal->count; ++i) {
    if (server->isPreemptRequested() || !ros::ok()) {
      result.code = hires::RolloutResult::CANCELLED;
      server->setPreempted(result);
      return;
    }
    server->publishFeedback(hires::RolloutFeedback());
    pace.sleep();
  }
  result.code = hires::RolloutResult::FINISHED;
  server->setSucceeded(result);
}

int Work(ros::NodeHandle& nh, const Arguments& arguments) {
  Server server(
      nh, arguments.at(0) + "/rollout",
      [&server](const hires::RolloutGoalConstPtr& goal) { Play(goal, &server); }, false);
  ros::Publisher state = nh.advertise<std_msgs::String>(arguments.at(0) + "/state", 1, true);
  std_msgs::String text;
  text.data = "idle";
  state.publish(text);
  server.start();
  ros::spin();
  return 0;
}

int SendGoal(ros::NodeHandle&, const Arguments& arguments) {
  actionlib::SimpleActionClient<hires::RolloutAction> client(arguments.at(0) + "/rollout", true);
  client.waitForServer();
  hires::RolloutGoal goal;
  goal.count = static_cast<std::uint32_t>(std::stoul(arguments.at(1)));
  const int cancel_after = std::stoi(arguments.at(2));
  int num_feedback = 0;
  client.sendGoal(goal, {}, {}, [&](const hires::RolloutFeedbackConstPtr&) {
    std::cout << "feedback=" << ++num_feedback << std::endl;
    if (num_feedback == cancel_after) client.cancelGoal();
  });
  client.waitForResult();
  std::cout << "state=" << client.getState().toString()
            << " code=" << static_cast<int>(client.getResult()->code)
            << " feedbacks=" << num_feedback << std::endl;
  return 0;
}

const std::map<std::string, std::function<int(ros::NodeHandle&, const Arguments&)>> kParts{
    {"stream", Stream}, {"latch", Latch},       {"clock", Clock},  {"count", Count},
    {"hear", Hear},     {"echo", Echo},         {"serve", Serve},  {"call", Call},
    {"worker", Work},   {"pingpong", PingPong}, {"goal", SendGoal}};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "relay_test_peer");  // takes its own arguments away
  const Arguments arguments(argv + 1, argv + argc);
  const auto part = arguments.empty() ? kParts.end() : kParts.find(arguments.front());
  if (part == kParts.end()) {
    std::cerr << "relay_test_peer: no such part; see the top of relay_test_peer.cpp\n";
    return 2;
  }
  ros::NodeHandle nh;
  return part->second(nh, Arguments(arguments.begin() + 1, arguments.end()));
}
