#include "hires/relay/uri.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"

namespace hires::relay::uri_test {
namespace {

TEST(ParseUriTest, ReadsHostAndPort) {
  EXPECT_EQ(ParseUri("http://localhost:11311/"), (Endpoint{"localhost", 11311}));
  EXPECT_EQ(ParseUri("http://robot-1.lab_a:65535"), (Endpoint{"robot-1.lab_a", 65535}));
  EXPECT_EQ(ParseUri("rosrpc://10.0.0.7:1"), (Endpoint{"10.0.0.7", 1}));
  EXPECT_EQ(ParseUri("http://[fe80::1%eth0]:8080/"), (Endpoint{"fe80::1%eth0", 8080}));
}

TEST(ParseUriTest, GivesNothingForWhatIsNoAddress) {
  for (const char* text :
       {"", "http://", "http://:11311/", "http://host", "http://host:", "http://host:0",
        "http://host:65536", "http://host:99999999999", "http://host:12x", "http://host:-1",
        "https://host:1", "ftp://host:1", "http://a b:1", "http://host:1/path", "http://::1:80",
        "http://[host]:1", "http://[]:1", "http://user@host:1", "localhost:11311"}) {
    EXPECT_FALSE(ParseUri(text)) << text;
  }
}

TEST(RequireMasterUriTest, NamesWhereWhatAndWanted) {
  try {
    RequireMasterUri("rosrpc://h:1", "ROS_MASTER_URI");
    FAIL() << "a service address passed as a master's";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("ROS_MASTER_URI is 'rosrpc://h:1', wanted"));
  }
  EXPECT_EQ(RequireMasterUri("http://h:1/", "x"), (Endpoint{"h", 1}));
}

TEST(IsLoopbackTest, KnowsTheLoopbackNamesAndNoOthers) {
  for (const char* host : {"localhost", "LocalHost", "127.0.0.1", "127.0.1.1", "::1"}) {
    EXPECT_TRUE(IsLoopback(host)) << host;
  }
  for (const char* host : {"128.0.0.1", "localhost.lab", "10.127.0.1", "robot", "::2", ""}) {
    EXPECT_FALSE(IsLoopback(host)) << host;
  }
}

TEST(IsSamePlaceTest, TellsThisComputerFromOthers) {
  const HostNames here{"station", "10.0.0.5"};
  EXPECT_TRUE(IsSamePlace("localhost", "127.0.0.1", here));
  EXPECT_TRUE(IsSamePlace("Station", "localhost", here));
  EXPECT_TRUE(IsSamePlace("10.0.0.5", "station", here));
  EXPECT_TRUE(IsSamePlace("robot", "ROBOT", here));
  EXPECT_FALSE(IsSamePlace("localhost", "robot", here));
  EXPECT_FALSE(IsSamePlace("robot", "10.0.0.9", here));
}

}  // namespace
}  // namespace hires::relay::uri_test
