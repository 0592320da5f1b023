#include "hires/relay/mirror.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace hires::relay::mirror_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr char kUri[] = "http://127.0.0.1:4001/";
constexpr char kOtherUri[] = "http://127.0.0.1:4002/";

AliasNames Names() { return AliasNames("/mirrored", "worker_1"); }

std::string TextOf(const MirrorPlan& plan) {
  std::string text;
  for (const auto& r : plan.withdraw) {
    text += fmt::format("- {} {} as {}\n", NameOf(r.kind), r.name, r.alias);
  }
  for (const auto& a : plan.announce) {
    text += fmt::format("+ {} {} as {}\n", NameOf(a.offer.kind), a.offer.name, a.alias);
  }
  for (const auto& r : plan.refused) {
    text += fmt::format("! {} {} of {}: {}\n", NameOf(r.kind), r.name, r.node, r.reason);
  }
  return text;
}

TEST(AliasNamesTest, DependOnNodeAndAddressAndNothingElse) {
  const std::string alias = Names().AliasOf("/sim_worker", kUri);
  EXPECT_THAT(alias, testing::MatchesRegex("/mirrored/worker_1/sim_worker_[0-9a-f]{8}"));
  EXPECT_EQ(alias, Names().AliasOf("/sim_worker", kUri));
  EXPECT_NE(alias, Names().AliasOf("/sim_worker", kOtherUri));
  EXPECT_NE(alias, Names().AliasOf("/sim_worker2", kUri));
}

TEST(AliasNamesTest, OwnAliasesAreToldFromThoseOfOtherRelaysAndFromNodes) {
  EXPECT_TRUE(Names().IsOwn("/mirrored/worker_1/a"));
  EXPECT_FALSE(Names().IsOwn("/mirrored/worker_10/a"));
  EXPECT_TRUE(Names().IsAnyAlias("/mirrored/worker_10/a"));
  EXPECT_FALSE(Names().IsAnyAlias("/mirrored_by_me"));
  EXPECT_FALSE(Names().IsAnyAlias("/a/mirrored/worker_1/a"));
}

TEST(ListedOffersTest, ListsNeitherUnlistedNamesNorAliasesOfAnyRelay) {
  const Route route{NameFilter({"/worker_1/.*"}, "x"), NameFilter({"/reset"}, "x")};
  Graph graph;
  graph.publishers["/worker_1/scan"] = {"/b", "/a", "/mirrored/worker_1/a_00000000",
                                        "/mirrored/worker_2/b_00000000"};
  graph.publishers["/odom"] = {"/a"};
  graph.services["/reset"] = {"/a"};
  graph.services["/worker_1/stop"] = {"/a"};
  std::vector<std::string> seen;
  for (const Offer& offer : ListedOffers(graph, route, Names())) {
    seen.push_back(fmt::format("{} {} {}", NameOf(offer.kind), offer.name, offer.node));
  }
  EXPECT_THAT(
      seen, ElementsAre("topic /worker_1/scan /a", "topic /worker_1/scan /b", "service /reset /a"));
}

TEST(PlanMirrorTest, ComparesWhatShouldStandWithWhatStands) {
  const std::string kept = Names().AliasOf("/kept", kUri);
  Graph target;
  target.publishers["/kept"] = {kept, "/somebody"};
  target.publishers["/gone"] = {"/mirrored/worker_1/gone_12345678"};
  target.publishers["/others"] = {"/mirrored/worker_2/x_12345678"};
  target.services["/moved"] = {Names().AliasOf("/server", kUri)};
  target.services["/taken"] = {"/somebody"};
  const std::vector<Offer> offers{{Kind::kTopic, "/kept", "/kept", kUri},
                                  {Kind::kTopic, "/new", "/kept", kUri},
                                  {Kind::kService, "/moved", "/server", kOtherUri},
                                  {Kind::kService, "/taken", "/server", kOtherUri},
                                  {Kind::kTopic, "/odd", "/odd", "gopher://x"}};
  EXPECT_EQ(TextOf(PlanMirror(offers, target, Names(), true)),
            "- topic /gone as /mirrored/worker_1/gone_12345678\n"
            "- service /moved as " +
                Names().AliasOf("/server", kUri) +
                "\n"
                "+ topic /new as " +
                kept +
                "\n"
                "+ service /moved as " +
                Names().AliasOf("/server", kOtherUri) +
                "\n"
                "! service /taken of /server: the other master has this service already, from "
                "/somebody\n"
                "! topic /odd of /odd: its address 'gopher://x' is no http://host:port\n");
}

TEST(PlanMirrorTest, ALoopbackAddressStaysOnItsHost) {
  const std::vector<Offer> offers{{Kind::kTopic, "/near", "/near", kUri},
                                  {Kind::kTopic, "/far", "/far", "http://10.0.0.7:4001/"}};
  const MirrorPlan plan = PlanMirror(offers, {}, Names(), false);
  ASSERT_EQ(plan.announce.size(), 1u);
  EXPECT_EQ(plan.announce[0].offer.name, "/far");
  ASSERT_EQ(plan.refused.size(), 1u);
  EXPECT_EQ(plan.refused[0].name, "/near");
  EXPECT_THAT(plan.refused[0].reason, HasSubstr("ROS_IP"));
  EXPECT_THAT(PlanMirror(offers, {}, Names(), true).refused, IsEmpty());
}

TEST(PlanMirrorTest, CarryingOutAPlanLeavesNothingToDo) {
  std::vector<Offer> offers;
  for (int i = 0; i < 20; ++i) {
    offers.push_back({i % 2 == 0 ? Kind::kTopic : Kind::kService, fmt::format("/name_{}", i / 2),
                      fmt::format("/node_{}", i % 3), kUri});
  }
  Graph target;
  target.publishers["/old"] = {"/mirrored/worker_1/old_00000000"};
  for (const auto& withdrawn : PlanMirror(offers, target, Names(), true).withdraw) {
    target.publishers.erase(withdrawn.name);
  }
  for (const auto& [offer, alias] : PlanMirror(offers, target, Names(), true).announce) {
    (offer.kind == Kind::kTopic ? target.publishers : target.services)[offer.name].insert(alias);
  }
  EXPECT_EQ(TextOf(PlanMirror(offers, target, Names(), true)), "");
}

}  // namespace
}  // namespace hires::relay::mirror_test
