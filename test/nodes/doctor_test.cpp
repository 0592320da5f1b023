#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/init.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hires/relay/listening_sockets.h"
#include "nodes/hires/ros_doctor.h"
#include "support/messages.h"

namespace hires_ros::doctor_test {
namespace {

using hires::cli::FindingText;

namespace fs = std::filesystem;
using hires::test_support::ConfigErrorOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// As a little-endian Linux prints them.
constexpr char kHeads[] =
    "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
    "inode\n";
constexpr char kLoopbackMaster[] =
    "   0: 0100007F:2C94 00000000:0000 0A 00000000:00000000 00:00000000 00000000  1000        0 "
    "4711 1 0000000000000000 100 0 0 10 0\n";
constexpr char kEverywhere[] =
    "   1: 00000000:8003 00000000:0000 0A 00000000:00000000 00:00000000 00000000  1001        0 "
    "18446744073709551615 1 0000000000000000 100 0 0 10 0\n";
constexpr char kConnection[] =
    "   2: 0100007F:8003 0100007F:2C94 01 00000000:00000000 00:00000000 00000000  1000        0 "
    "4713 1 0000000000000000 20 4 30 10 -1\n";
constexpr char kSix[] =
    "   0: 00000000000000000000000000000000:2C95 00000000000000000000000000000000:0000 0A "
    "00000000:00000000 00:00000000 00000000     0        0 99 1 0000000000000000 100 0 0 10 0\n"
    "   1: 00000000000000000000000001000000:0016 00000000000000000000000000000000:0000 0A "
    "00000000:00000000 00:00000000 00000000     0        0 98 1 0000000000000000 100 0 0 10 0\n"
    "   2: 0000000000000000FFFF00000100007F:0017 00000000000000000000000000000000:0000 0A "
    "00000000:00000000 00:00000000 00000000     0        0 97 1 0000000000000000 100 0 0 10 0\n";

TEST(ListeningSocketsTest, OnlySocketsThatListenAreRead) {
  const auto sockets = hires::relay::ParseListeningSockets(
      std::string(kHeads) + kLoopbackMaster + kEverywhere + kConnection, "/proc/net/tcp");
  ASSERT_EQ(sockets.size(), 2u);
  EXPECT_EQ(sockets[0].address, "127.0.0.1");
  EXPECT_EQ(sockets[0].port, 11412);
  EXPECT_EQ(sockets[0].inode, 4711u);
  EXPECT_EQ(sockets[0].uid, 1000u);
  EXPECT_TRUE(sockets[0].is_loopback());
  EXPECT_FALSE(sockets[0].is_everywhere());
  EXPECT_EQ(sockets[1].address, "0.0.0.0");
  EXPECT_EQ(sockets[1].port, 32771);
  EXPECT_EQ(sockets[1].inode, 18446744073709551615u);
  EXPECT_FALSE(sockets[1].is_loopback());
  EXPECT_TRUE(sockets[1].is_everywhere());
}

TEST(ListeningSocketsTest, AddressesOfIpv6AreRead) {
  const auto sockets =
      hires::relay::ParseListeningSockets(std::string(kHeads) + kSix, "/proc/net/tcp6");
  ASSERT_EQ(sockets.size(), 3u);
  EXPECT_EQ(sockets[0].address, "::");
  EXPECT_TRUE(sockets[0].is_everywhere());
  EXPECT_EQ(sockets[1].address, "::1");
  EXPECT_TRUE(sockets[1].is_loopback());
  EXPECT_EQ(sockets[2].address, "::ffff:127.0.0.1");
  EXPECT_TRUE(sockets[2].is_loopback());
}

TEST(ListeningSocketsTest, ATableWithoutSocketsIsEmpty) {
  EXPECT_THAT(hires::relay::ParseListeningSockets(kHeads, "/proc/net/tcp"), IsEmpty());
  EXPECT_THAT(hires::relay::ParseListeningSockets("", "/proc/net/tcp6"), IsEmpty());
}

TEST(ListeningSocketsTest, ALineThatIsNoSocketIsNamed) {
  const std::string good = kLoopbackMaster;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string line = good;
    return line.replace(line.find(from), from.size(), to);
  };
  for (const std::string& line :
       {std::string("   0: 0100007F:2C94 0A\n"), with("0100007F:2C94", "0100007F"),
        with("0100007F:2C94", "0100007F:2C9"), with("0100007F:2C94", "0100007G:2C94"),
        with("0100007F:2C94", "100007F:2C94"), with(" 4711 ", " -4711 "),
        with(" 4711 ", " 99999999999999999999 "), with(" 1000 ", " root ")}) {
    EXPECT_THAT(ConfigErrorOf([&] {
                  hires::relay::ParseListeningSockets(kHeads + good + line, "/proc/net/tcp");
                }),
                HasSubstr("/proc/net/tcp: line 3 is '"))
        << line;
  }
}

TEST(ListeningSocketsTest, InodesComeFromSocketLinksAlone) {
  EXPECT_EQ(hires::relay::SocketInodeOf("socket:[4711]"), 4711u);
  for (const char* link : {"", "socket:", "socket:[", "socket:[]", "socket:[x]", "socket:[1]x",
                           "pipe:[4711]", "/tmp/socket:[4711]"}) {
    EXPECT_EQ(hires::relay::SocketInodeOf(link), std::nullopt) << link;
  }
}

TEST(ListeningSocketsTest, RosProgramsAreKnownByNameArgumentsLibraryOrLog) {
  const std::string logs = "/home/u/.ros/log";
  EXPECT_TRUE(hires::relay::LooksLikeRos(
      {{"/usr/bin/python3", "/usr/bin/rosmaster", "--core"}, "", {}}, logs));
  EXPECT_TRUE(hires::relay::LooksLikeRos({{"./talker", "__name:=talker"}, "", {}}, logs));
  EXPECT_TRUE(
      hires::relay::LooksLikeRos({{"./x"}, "7f00 r-xp /usr/lib/libroscpp.so.4d\n", {}}, logs));
  EXPECT_TRUE(hires::relay::LooksLikeRos({{"python3", "x.py"}, "", {logs + "/1/x.log"}}, logs));
  EXPECT_FALSE(hires::relay::LooksLikeRos({{"python3", "x.py"}, "", {"/home/u/.ros/logs"}}, logs));
  EXPECT_FALSE(hires::relay::LooksLikeRos({{"python3", "x.py"}, "", {"/etc/hosts"}}, ""));
  EXPECT_FALSE(hires::relay::LooksLikeRos(
      {{"sshd"}, "7f00 r-xp /usr/lib/libc.so.6\n", {"socket:[1]"}}, logs));
}

/// A folder that looks like /proc.
class FakeProc : public testing::Test {
 protected:
  FakeProc() {
    std::string name = (fs::temp_directory_path() / "hires_proc_XXXXXX").string();
    root_ = mkdtemp(name.data());
  }
  ~FakeProc() override { fs::remove_all(root_); }

  void AddProcess(const std::string& pid, const std::string& command, const std::string& link) {
    fs::create_directories(root_ / pid / "fd");
    std::ofstream(root_ / pid / "cmdline", std::ios::binary) << command;
    std::ofstream(root_ / pid / "maps") << "";
    fs::create_symlink("/dev/null", root_ / pid / "fd" / "0");
    fs::create_symlink(link, root_ / pid / "fd" / "3");
  }

  fs::path root_;
};

TEST_F(FakeProc, OwnersAreFoundByTheirSockets) {
  AddProcess("42", std::string("/usr/bin/python3\0-u\0/usr/bin/rosmaster\0--core\0", 45),
             "socket:[4711]");
  AddProcess("43", std::string("/usr/sbin/sshd\0", 15), "socket:[22]");
  AddProcess("44", std::string("other\0", 6), "socket:[5]");
  AddProcess("self", std::string("other\0", 6), "socket:[22]");
  const auto owners = hires::relay::FindSocketOwners(
      {{"127.0.0.1", 11412, 4711, 0}, {"0.0.0.0", 22, 22, 0}}, root_.string(), "");
  ASSERT_EQ(owners.size(), 2u);
  EXPECT_EQ(owners.at(4711).pid, 42);
  EXPECT_EQ(owners.at(4711).name, "rosmaster");
  EXPECT_TRUE(owners.at(4711).is_ros);
  EXPECT_EQ(owners.at(22).pid, 43);
  EXPECT_EQ(owners.at(22).name, "sshd");
  EXPECT_FALSE(owners.at(22).is_ros);
}

TEST_F(FakeProc, AProcessThatCannotBeLookedIntoIsLeftOut) {
  fs::create_directories(root_ / "7");
  EXPECT_THAT(hires::relay::FindSocketOwners({{"0.0.0.0", 22, 22, 0}}, root_.string(), ""),
              IsEmpty());
  EXPECT_THAT(
      hires::relay::FindSocketOwners({{"0.0.0.0", 22, 22, 0}}, (root_ / "none").string(), ""),
      IsEmpty());
}

// ---------------------------------------------------------------- judgements

const ResolveHost kResolve = [](const std::string& name) -> std::vector<std::string> {
  if (name == "localhost" || name == "127.0.0.1") return {"127.0.0.1"};
  if (name == "robot" || name == "10.0.0.7") return {"10.0.0.7"};
  if (name == "elsewhere" || name == "10.0.0.8") return {"10.0.0.8"};
  return {};
};
const hires::relay::HostNames kThisHost{"robot", "127.0.0.1", "10.0.0.7"};

std::string Names(const NameSettings& settings) {
  std::string text;
  for (const Finding& finding : JudgeNames(settings, kResolve, kThisHost)) {
    text += FindingText(finding);
  }
  return text;
}

TEST(JudgeNamesTest, LoopbackIsWell) {
  EXPECT_EQ(Names({"localhost", {}, "robot"}),
            "ok      ROS_HOSTNAME is 'localhost': nodes talk within this computer\n");
  EXPECT_EQ(Names({{}, "127.0.0.1", "robot"}),
            "ok      ROS_IP is '127.0.0.1': nodes talk within this computer\n");
}

TEST(JudgeNamesTest, AnAddressThatOthersReachIsNoted) {
  EXPECT_THAT(Names({{}, "10.0.0.7", "robot"}), HasSubstr("note    ROS_IP is '10.0.0.7'"));
  EXPECT_THAT(
      Names({{}, {}, "robot"}),
      HasSubstr("note    ROS_HOSTNAME is not set, so the host's name counts: it is 'robot', "
                "that is 10.0.0.7: other computers can"));
}

TEST(JudgeNamesTest, NamesThatLeadNowhereOrElsewhereFail) {
  EXPECT_THAT(Names({"robbot", {}, "robot"}),
              HasSubstr("FAILED  ROS_HOSTNAME is 'robbot', a name that cannot be looked up"));
  EXPECT_THAT(Names({{}, {}, "nameless"}), HasSubstr("FAILED"));
  EXPECT_THAT(Names({"elsewhere", {}, "robot"}), HasSubstr("FAILED"));
  EXPECT_THAT(Names({{}, "10.0.0.8", "robot"}),
              HasSubstr("that is 10.0.0.8, no address of this computer"));
  EXPECT_THAT(Names({{}, "robot", "robot"}), HasSubstr("FAILED  ROS_IP is 'robot', wanted"));
}

TEST(JudgeNamesTest, OfTwoSettingsTheFirstCounts) {
  EXPECT_THAT(Names({"localhost", "10.0.0.8", "robot"}),
              AllOf(HasSubstr("warn    ROS_HOSTNAME 'localhost' and ROS_IP '10.0.0.8' are both"),
                    HasSubstr("ok      ROS_HOSTNAME"), Not(HasSubstr("FAILED"))));
}

TEST(JudgeMasterTest, OnlyAnUnusableAddressFails) {
  const auto nobody = [](const hires::relay::Endpoint&) { return std::optional<int>(); };
  const auto somebody = [](const hires::relay::Endpoint& master) -> std::optional<int> {
    return master.host == "localhost" && master.port == 11311 ? std::optional<int>(12)
                                                              : std::nullopt;
  };
  EXPECT_EQ(JudgeMaster("http://localhost:11311", somebody).level, FindingLevel::kOk);
  EXPECT_EQ(JudgeMaster("http://localhost:11311", nobody).level, FindingLevel::kNote);
  EXPECT_EQ(JudgeMaster({}, nobody).level, FindingLevel::kWarning);
  const Finding bad = JudgeMaster("localhost:11311", nobody);
  EXPECT_EQ(bad.level, FindingLevel::kFailed);
  EXPECT_THAT(bad.text, AllOf(HasSubstr("ROS_MASTER_URI"), HasSubstr("localhost:11311")));
}

TEST(JudgeOpenPortsTest, OnlyRosProgramsBeyondLoopbackAreListed) {
  const std::vector<hires::relay::ListeningSocket> sockets{{"0.0.0.0", 40001, 1, 0},
                                                           {"127.0.0.1", 40002, 2, 0},
                                                           {"0.0.0.0", 22, 3, 0},
                                                           {"::", 40004, 4, 0},
                                                           {"10.0.0.7", 40005, 5, 0}};
  const SocketOwners owners{{1, {11, "sim_worker", true}},
                            {2, {12, "rosmaster", true}},
                            {3, {13, "sshd", false}},
                            {5, {15, "planner", true}}};
  const auto findings = JudgeOpenPorts(sockets, owners, 32768, 60999);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].level, FindingLevel::kWarning);
  EXPECT_THAT(findings[0].text,
              AllOf(HasSubstr("0.0.0.0 port 40001: sim_worker (process id 11)"),
                    HasSubstr("10.0.0.7 port 40005: planner (process id 15)"),
                    HasSubstr("tcp dport { 11311, 11412-11419, 32768-60999 } drop"),
                    Not(HasSubstr("sshd")), Not(HasSubstr("rosmaster")), Not(HasSubstr("40004"))));
}

TEST(JudgeOpenPortsTest, NothingOpenIsWell) {
  const auto findings = JudgeOpenPorts({{"127.0.0.1", 40002, 2, 0}}, {{2, {12, "x", true}}}, 1, 2);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].level, FindingLevel::kOk);
}

std::vector<FindingLevel> LevelsOf(const std::vector<Finding>& findings) {
  std::vector<FindingLevel> levels;
  for (const Finding& finding : findings) levels.push_back(finding.level);
  return levels;
}

TEST(JudgeWorkerPortsTest, ATakenPortIsNamedWithItsOwner) {
  const std::vector<hires::relay::ListeningSocket> sockets{
      {"127.0.0.1", 11412, 1, 0}, {"0.0.0.0", 11413, 2, 0},   {"::", 11414, 3, 1001},
      {"10.0.0.7", 11415, 4, 0},  {"127.0.0.1", 11411, 5, 0}, {"127.0.0.1", 11420, 6, 0}};
  const SocketOwners owners{{1, {11, "rosmaster", true}}, {2, {12, "webserver", false}}};
  const auto findings = JudgeWorkerPorts(sockets, owners, 11411, 8);
  EXPECT_THAT(LevelsOf(findings),
              ElementsAre(FindingLevel::kOk, FindingLevel::kWarning, FindingLevel::kWarning));
  EXPECT_THAT(findings[0].text, HasSubstr("worker 1 runs, rosmaster (process id 11)"));
  EXPECT_THAT(findings[1].text, HasSubstr("port 11413 is taken by webserver (process id 12), so "
                                          "worker 2 cannot start"));
  EXPECT_THAT(findings[2].text, HasSubstr("taken by a program of user id 1001"));
}

TEST(JudgeWorkerPortsTest, FreePortsAreWell) {
  const auto findings = JudgeWorkerPorts({}, {}, 11411, 8);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(FindingText(findings[0]),
            "ok      ports 11412 to 11419 are free for masters of workers\n");
}

TEST(JudgeNicenessTest, WorkersMustComeBehind) {
  EXPECT_EQ(JudgeNiceness(0, 10, true).level, FindingLevel::kOk);
  EXPECT_EQ(JudgeNiceness(10, 10, true).level, FindingLevel::kOk);
  EXPECT_EQ(JudgeNiceness(11, 10, true).level, FindingLevel::kWarning);
  EXPECT_EQ(JudgeNiceness(0, 10, false).level, FindingLevel::kFailed);
}

TEST(JudgeSpaceTest, LittleSpaceIsAWarning) {
  EXPECT_EQ(JudgeSpace("/logs", 1000000000).level, FindingLevel::kOk);
  EXPECT_EQ(JudgeSpace("/logs", 999999999).level, FindingLevel::kWarning);
}

TEST(FindingTextTest, FurtherLinesAreIndented) {
  EXPECT_EQ(FindingText({FindingLevel::kWarning, "a\nb"}), "warn    a\n          b\n");
}

// ---------------------------------------------------------------- this computer

/// A socket of this test that listens.
class OpenPort {
 public:
  explicit OpenPort(const char* address) : fd_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in where{};
    where.sin_family = AF_INET;
    inet_pton(AF_INET, address, &where.sin_addr);
    socklen_t size = sizeof(where);
    is_open_ = bind(fd_, reinterpret_cast<sockaddr*>(&where), size) == 0 && listen(fd_, 1) == 0 &&
               getsockname(fd_, reinterpret_cast<sockaddr*>(&where), &size) == 0;
    port_ = ntohs(where.sin_port);
  }
  ~OpenPort() { close(fd_); }
  bool is_open() const { return is_open_; }
  int port() const { return port_; }

 private:
  int fd_;
  bool is_open_{false};
  int port_{0};
};

std::string ReadProc(const char* path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ThisComputerTest, ASocketOfThisProcessIsFoundAndKnownAsRos) {
  const OpenPort mine("127.0.0.1");
  ASSERT_TRUE(mine.is_open());
  const auto sockets =
      hires::relay::ParseListeningSockets(ReadProc("/proc/net/tcp"), "/proc/net/tcp");
  const auto found = std::find_if(sockets.begin(), sockets.end(), [&](const auto& socket) {
    return socket.port == mine.port() && socket.is_loopback();
  });
  ASSERT_NE(found, sockets.end());
  EXPECT_EQ(found->uid, geteuid());
  const auto owners = hires::relay::FindSocketOwners({*found}, "/proc", "");
  ASSERT_EQ(owners.count(found->inode), 1u);
  EXPECT_EQ(owners.at(found->inode).pid, getpid());
  EXPECT_EQ(owners.at(found->inode).name, program_invocation_short_name);
  EXPECT_FALSE(ros::isInitialized()) << "a call into roscpp, which links this test with it";
  EXPECT_TRUE(owners.at(found->inode).is_ros);
}

TEST(ThisComputerTest, EveryFindingSaysSomething) {
  const auto findings = ExamineRos();
  EXPECT_GE(findings.size(), 6u);
  for (const Finding& finding : findings) EXPECT_FALSE(finding.text.empty());
}

}  // namespace
}  // namespace hires_ros::doctor_test
