#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "hires/geometry/angles.h"
#include "hires/robot/gripper.h"
#include "hires/sensing/object_memory.h"
#include "support/sight_scenes.h"

/// Long random histories of things of two kinds, seen by a recogniser that knows kinds alone.
namespace hires::sensing::object_histories_test {
namespace {

using Eigen::Vector3d;
using perception::Detection;
using perception::LineOfSight;
using test_support::At;
using test_support::Thing;

constexpr double kNoise = 0.003;   // [m] sd of each coordinate of a detection
constexpr double kBlur = 0.015;    // [m] by which a detection errs at most
constexpr double kLag = 0.04;      // [m] MemoryParams::moved_distance
constexpr double kBlending = 0.3;  // MemoryParams::blending
constexpr double kReach = 0.1;     // [m] MemoryParams::instance_distance
constexpr double kApart = 0.1;     // [m] between things at least
constexpr double kClear = 0.17;    // [m] around a place where nothing can hide it
constexpr int kSettled = 6;        // looks after which what was moved has a name again
constexpr int kMaxDropouts = 2;    // in a row: one more, and it counts as gone

const std::shared_ptr<const robot::Robot>& Pr2() {
  static const auto pr2 = std::make_shared<const robot::Robot>(
      robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml"));
  return pr2;
}

/// A PR2 at the origin that looks down at a table, its arms at its sides.
BodyReading LookingDown() {
  BodyReading body;
  body.joints = Pr2()->profile.joints;
  body.joints["head_pan_joint"] = 0.0;
  body.joints["head_tilt_joint"] = 0.5;
  const robot::UpperBodyProfile& upper = *Pr2()->profile.upper_body;
  for (const auto& [unused, arm] : upper.arms) {
    const auto& positions = arm.postures.at("armtosideposture")[0];
    for (std::size_t i = 0; i < positions.size(); ++i) body.joints[arm.joints[i]] = positions[i];
    robot::SetGap(upper.gripper, arm, 0.0, &body.joints);
  }
  return body;
}

struct TrueThing {
  std::string kind;
  Vector3d p_M{0, 0, 0};
  bool is_there{true};
  Vector3d seen_M{0, 0, 0};  ///< where it was when it was detected last
  int num_still{0};          ///< looks that saw it where it is ...
  int num_in_row{0};         ///< ... without a look between that did not
  int num_dropouts{0};       ///< in a row
  std::string name{};        ///< that it has by what is certain; empty: not certain
  bool is_adrift{false};     ///< was carried, taken away or shown again; its name has to come back
  bool is_detected{false};   ///< in the last look
  bool is_mistaken{false};   ///< for the other kind, when it was detected last

  double moved() const { return (p_M - seen_M).norm(); }  ///< [m]
  /// [m] that what is remembered of it may be behind a small move.
  double lag() const { return kLag * std::pow(1.0 - kBlending, num_still); }
};

/// What was checked over many histories.
struct Tally {
  int looks{0}, ambiguous{0};
  int kept{0};       ///< sights of things that did not move, with their names
  int followed{0};   ///< sights of things that moved by less than the reach
  int undecided{0};  ///< sights of such in ambiguous looks, where the name stayed behind
  int returned{0};   ///< names that came back to what was carried, or taken and shown again
  int swapped{0};    ///< pairs behind the screen
  int hidden{0};     ///< things that something hid, by looks
};

class History {
 public:
  History(std::uint64_t seed, Tally* tally) : rng_(seed), tally_(tally) {
    const int num_mugs = 2 + rng_.Index(2), num_jugs = 1 + rng_.Index(2);
    for (int i = 0; i < num_mugs + num_jugs; ++i) {
      TrueThing thing{i < num_mugs ? "mug" : "jug"};
      thing.is_there = false;
      if (const auto place = FreePlace(thing.kind)) thing.p_M = thing.seen_M = *place;
      thing.is_there = true;
      things_.push_back(thing);
    }
  }

  void Play(int num_events) {
    Wait(kSettled);
    for (int i = 0; i < num_events && !testing::Test::HasFailure(); ++i) {
      // The first look at what is put before other things still misses them: it takes no more.
      may_drop_out_ = false;
      Wait(1);
      switch (rng_.Index(10)) {
        case 0:
        case 1:
        case 2:
          Nudge(1);
          break;
        case 3:
          Nudge(2);
          break;
        case 4:
        case 5:
          Carry();
          break;
        case 6:
        case 7:
          TakeOrShow();
          break;
        case 8:
          Exchange();
          break;
        default:
          SwapBehindScreen();
      }
      Wait(rng_.Bernoulli(0.6) ? kSettled : 1 + rng_.Index(3));
    }
    Wait(2 * kSettled);
  }

 private:
  // ---- What happens.

  bool IsFree(const Vector3d& p_M, const TrueThing* but = nullptr) const {
    return std::all_of(things_.begin(), things_.end(), [&](const TrueThing& other) {
      return &other == but || !other.is_there || (other.p_M - p_M).norm() >= kApart;
    });
  }
  /// Every third one is as near to another of its kind as may be.
  std::optional<Vector3d> FreePlace(const std::string& kind) {
    for (int i = 0; i < 50; ++i) {
      Vector3d p_M(rng_.Uniform(1.2, 1.6), rng_.Uniform(-0.4, 0.4), 0.7);
      if (rng_.Index(3) == 0) {
        for (const TrueThing& other : things_)
          if (other.is_there && other.kind == kind)
            p_M = other.p_M + (kApart + rng_.Uniform(0.0, 0.03)) * Direction();
      }
      if (IsFree(p_M) && IsOnTable(p_M)) return p_M;
    }
    return std::nullopt;
  }
  /// Within 2 m of the camera, beyond which nothing is missed.
  static bool IsOnTable(const Vector3d& p_M) {
    return std::abs(p_M.x() - 1.4) <= 0.2 && std::abs(p_M.y()) <= 0.4;
  }
  Vector3d Direction() {
    const double yaw = rng_.Uniform(-geometry::kPi, geometry::kPi);
    return {std::cos(yaw), std::sin(yaw), 0.0};
  }
  /// Neither a thing nor what is believed to be one hides anything there.
  bool IsClear(const TrueThing& thing) const {
    const auto is_beside = [&](const Vector3d& p_M) {
      const Vector3d way = p_M - thing.p_M;
      return way.norm() <= kClear || (way.x() < 0.0 && std::abs(way.y()) < kClear);
    };
    const auto has_left = [&](const auto& left) {
      return std::any_of(left.second.begin(), left.second.end(), is_beside);
    };
    return std::none_of(left_.begin(), left_.end(), has_left) &&
           std::none_of(things_.begin(), things_.end(), [&](const TrueThing& other) {
             return &other != &thing && other.is_there && is_beside(other.p_M);
           });
  }
  TrueThing& AnyThing() { return things_[rng_.Index(static_cast<int>(things_.size()))]; }

  void Nudge(int count) {
    for (int i = 0; i < count; ++i) {
      TrueThing& thing = AnyThing();
      if (!thing.is_there || thing.is_adrift) continue;
      const Vector3d to = thing.p_M + rng_.Uniform(0.02, 0.09) * Direction();
      if (!IsFree(to, &thing) || !IsOnTable(to)) continue;
      thing.p_M = to;
      quiet_ = 0;
    }
  }
  /// Where it was something may hide that it is gone, or it is not the only one of its kind whose
  /// name is free: then who it is cannot be told.
  void Uproot(TrueThing* thing) {
    quiet_ = 0;
    const bool is_alone = std::none_of(things_.begin(), things_.end(), [&](const TrueThing& one) {
      return &one != thing && one.kind == thing->kind && one.is_adrift;
    });
    const bool is_unseen = thing->is_there && (!IsClear(*thing) || !thing->is_detected);
    if (is_unseen) left_[thing->kind].push_back(thing->p_M);
    if (!is_alone || thing->name.empty() || !left_[thing->kind].empty()) Forget(thing->kind);
    thing->is_adrift = true;
  }
  void Forget(const std::string& kind) {
    for (TrueThing& thing : things_)
      if (thing.kind == kind) thing.name.clear();
  }
  bool CarryTo(TrueThing* thing, const std::optional<Vector3d>& to) {
    if (!to || !thing->is_there || (*to - thing->p_M).norm() < kReach + 2 * kBlur) return false;
    Uproot(thing);
    thing->p_M = *to;
    return true;
  }
  void Carry() {
    TrueThing& thing = AnyThing();
    CarryTo(&thing, FreePlace(thing.kind));
  }
  void TakeOrShow() {
    TrueThing& thing = AnyThing();
    const auto to = thing.is_there || rng_.Bernoulli(0.3) ? thing.p_M : FreePlace(thing.kind);
    if (!thing.is_there && (!to || !IsFree(*to))) return;
    Uproot(&thing);
    thing.p_M = *to;
    thing.is_there = !thing.is_there;
  }
  /// Two of a kind change places, one after the other, in full view.
  void Exchange() {
    TrueThing &one = AnyThing(), &other = AnyThing();
    if (&one == &other || one.kind != other.kind || !one.is_there || !other.is_there) return;
    const Vector3d first = one.p_M, second = other.p_M;
    if (!CarryTo(&one, FreePlace(one.kind))) return;
    Wait(kSettled);
    if (!IsFree(first, &other) || !CarryTo(&other, first)) return;
    Wait(kSettled);
    if (IsFree(second, &one)) CarryTo(&one, second);
  }
  /// Nobody can know of it: each has the name that belongs to its place.
  void SwapBehindScreen() {
    const double sides[] = {-0.3, 0.0, 0.3};
    screen_ = Thing("screen1", "screen", At(1.0, sides[rng_.Index(3)], 0.7));
    Wait(2 + rng_.Index(4));
    for (int i = 0; i < 20; ++i) {
      TrueThing &one = AnyThing(), &other = AnyThing();
      if (&one == &other || one.kind != other.kind || one.is_adrift || other.is_adrift ||
          !one.is_there || !other.is_there || one.is_detected || other.is_detected ||
          one.num_dropouts > 0 || other.num_dropouts > 0)
        continue;
      std::swap(one.p_M, other.p_M);
      std::swap(one.seen_M, other.seen_M);
      std::swap(one.name, other.name);
      ++tally_->swapped;
      break;
    }
    Wait(rng_.Index(4));
    screen_.reset();
    Wait(kSettled);
  }

  // ---- Looks.

  void Wait(int looks) {
    for (int i = 0; i < looks && !testing::Test::HasFailure(); ++i) {
      Look();
      may_drop_out_ = true;
    }
  }
  std::vector<Detection> Detections() {
    std::vector<world::ObjectState> truth;
    for (std::size_t i = 0; i < things_.size(); ++i) {
      const TrueThing& one = things_[i];
      if (one.is_there)
        truth.push_back(Thing(std::to_string(i), one.kind, At(one.p_M.x(), one.p_M.y(), 0.7)));
    }
    if (screen_) truth.push_back(*screen_);
    const LineOfSight sight(room_, truth, {});  // its arms hide nothing
    std::vector<Detection> out;
    for (TrueThing& thing : things_) thing.is_detected = false;
    for (Detection& one : Detect(sight, view_, truth, {0.3, kNoise, 0.02}, &rng_)) {
      if (one.instance != "screen1") {
        TrueThing& thing = things_[std::stoi(*one.instance)];
        if (may_drop_out_ && thing.num_dropouts < kMaxDropouts && rng_.Bernoulli(0.06)) {
          ++thing.num_dropouts;
          continue;
        }
        thing.num_dropouts = 0;
        thing.is_detected = true;
        one.instance.reset();
        Doubt(&thing, &one);
      }
      out.insert(out.begin() + rng_.Index(static_cast<int>(out.size()) + 1), one);
    }
    return out;
  }
  /// Now and then the other kind may be it, or, for one look, seems a bit more likely.
  void Doubt(TrueThing* thing, Detection* detection) {
    const bool was_mistaken = std::exchange(thing->is_mistaken, false);
    if (!rng_.Bernoulli(0.1)) return;
    const std::string other = thing->kind == "mug" ? "jug" : "mug";
    // Where a name may have stayed, one look may well give it away.
    thing->is_mistaken = !was_mistaken && left_[other].empty() && rng_.Bernoulli(0.5);
    detection->confidence = thing->is_mistaken ? 0.45 : 0.8;
    detection->alternatives = {{other, 0.2}};
    if (!thing->is_mistaken) return;
    detection->alternatives[0].confidence = 0.5;
    std::swap(detection->label, detection->alternatives[0].label);
    std::swap(detection->confidence, detection->alternatives[0].confidence);
  }
  void Look() {
    for (const TrueThing& thing : things_) places_[thing.kind].push_back(thing.p_M);
    const std::vector<Detection> detections = Detections();
    FindUndecidable();
    body_.time += 0.5;
    memory_.Look(body_, detections);
    ++quiet_;
    ++tally_->looks;
    tally_->ambiguous += memory_.num_ambiguous() > 0;
    Check();
    for (TrueThing& thing : things_) {
      tally_->hidden += thing.is_there && !thing.is_detected && thing.num_dropouts == 0;
      const bool is_still = thing.moved() <= 0.0;
      thing.num_in_row = thing.is_detected ? thing.num_in_row * is_still + 1 : 0;
      if (!thing.is_detected) continue;
      thing.num_still = thing.num_still * is_still + 1;
      thing.seen_M = thing.p_M;
    }
    Learn();
  }

  // ---- What must hold.

  /// Whether its place, as remembered, is within reach.
  static bool IsNear(const TrueThing& thing) {
    return thing.moved() + thing.lag() + kBlur < kReach;
  }
  /// Who moved so far that the place of another of its kind is nearer, that one may be.
  void FindUndecidable() {
    for (TrueThing& thing : things_) {
      if (!thing.is_detected) continue;
      if (!thing.is_adrift && !IsNear(thing)) {  // it moved on while it was hidden
        thing.is_adrift = true;
        left_[thing.kind].push_back(thing.seen_M);
        Forget(thing.kind);
      }
      const double own = thing.is_adrift ? kReach : thing.moved() + thing.lag() + kBlur;
      const auto is_nearer = [&](const Vector3d& p_M, double lag) {
        const double way = (thing.p_M - p_M).norm() - lag - kBlur;
        return way < kReach && way <= own;
      };
      const bool is_undecidable =
          std::any_of(things_.begin(), things_.end(),
                      [&](const TrueThing& other) {
                        return &other != &thing && other.kind == thing.kind &&
                               is_nearer(other.seen_M, other.lag());
                      }) ||
          std::any_of(left_[thing.kind].begin(), left_[thing.kind].end(),
                      [&](const Vector3d& p_M) { return is_nearer(p_M, kLag); });
      if (!is_undecidable) continue;
      Forget(thing.kind);
      if (thing.moved() > 0.0) left_[thing.kind].push_back(thing.seen_M);
    }
  }
  std::string NameAt(const TrueThing& thing) const {
    std::string name;
    for (const auto& [one, object] : memory_.objects()) {
      const bool is_it = object.model == thing.kind && object.time == body_.time &&
                         (object.X_LO.translation - thing.p_M).norm() < kBlur + kLag;
      if (!is_it) continue;
      EXPECT_EQ(name, "") << "one thing has a second name, " << one << Told();
      name = one;
    }
    return name;
  }
  std::string Told() const {
    std::string text = fmt::format("\nseed {}, look {:.0f}, ambiguous {}", rng_.seed(),
                                   2 * body_.time, memory_.num_ambiguous());
    for (const TrueThing& t : things_)
      text +=
          fmt::format("\n  {} '{}' at {:.3f} {:.3f}, last {:.3f} {:.3f}{}{}{}", t.kind, t.name,
                      t.p_M.x(), t.p_M.y(), t.seen_M.x(), t.seen_M.y(), t.is_there ? "" : " away",
                      t.is_detected ? "" : " unseen", t.is_adrift ? " adrift" : "");
    for (const auto& [name, o] : memory_.objects())
      text += fmt::format("\n  remembered {} at {:.3f} {:.3f}, seen {:.1f} s ago, missed {}", name,
                          o.X_LO.translation.x(), o.X_LO.translation.y(), body_.time - o.time,
                          o.num_missed);
    for (const std::string& name : memory_.Vanished()) text += "\n  vanished " + name;
    return text;
  }
  void Check() {
    std::map<std::string, std::set<std::string>> names;
    for (const std::string& name : memory_.Vanished()) names[name.substr(0, 3)].insert(name);
    for (const auto& [name, object] : memory_.objects()) {
      if (name == "screen1") continue;
      names[object.model].insert(name);
      const auto& places = places_[object.model];
      EXPECT_TRUE(std::any_of(places.begin(), places.end(),
                              [&, &object = object](const auto& p) {
                                return (object.X_LO.translation - p).norm() < kBlur + kLag;
                              }))
          << name << " is where none was" << Told();
    }
    for (const auto& [kind, all] : names) {
      const auto shown = std::count_if(things_.begin(), things_.end(),
                                       [&](const auto& thing) { return thing.kind == kind; });
      if (kind == "scr") continue;
      EXPECT_LE(static_cast<int>(all.size()), shown + static_cast<int>(left_[kind].size()))
          << kind << Told();
    }
    for (TrueThing& thing : things_) {
      if (!thing.is_detected) continue;
      const std::string name = NameAt(thing);
      if (!thing.name.empty() && !thing.is_adrift) CheckName(thing, name);
      EXPECT_TRUE(thing.num_in_row < kSettled || quiet_ < 2 * kSettled || !name.empty() ||
                  memory_.num_newcomers() > 0)
          << thing.kind << Told();
    }
  }
  void CheckName(const TrueThing& thing, const std::string& name) {
    const double moved = thing.moved();
    if (moved > 0.0 && name.empty() && memory_.num_ambiguous() > 0) {
      ++tally_->undecided;
      return;
    }
    EXPECT_EQ(name, thing.name) << "it moved by " << moved << Told();
    ++(moved > 0.0 ? tally_->followed : tally_->kept);
  }
  /// Names become certain again when all has stood still for a while.
  void Learn() {
    if (quiet_ < kSettled || memory_.num_ambiguous() > 0) return;
    for (TrueThing& thing : things_) {
      if (!thing.is_detected) continue;
      const std::string name = NameAt(thing);
      if (name.empty()) continue;
      if (thing.is_adrift && !thing.name.empty()) {
        EXPECT_EQ(name, thing.name) << Told();
        ++tally_->returned;
      }
      thing.is_adrift = false;
      thing.name = name;
    }
  }

  std::shared_ptr<const perception::Surroundings> room_ = test_support::EmptyRoom();
  ObjectMemory memory_{room_, Pr2()};
  BodyReading body_ = LookingDown();
  const perception::CameraView view_ = perception::ViewOf(*Pr2(), body_.X_MB, body_.joints);
  base::Rng rng_;
  Tally* tally_;
  std::vector<TrueThing> things_;
  std::optional<world::ObjectState> screen_;
  std::map<std::string, std::vector<Vector3d>> places_;  // of a kind, ever
  std::map<std::string, std::vector<Vector3d>> left_;    // of a kind, where a name may have stayed
  bool may_drop_out_{true};
  int quiet_{0};  // looks since something was moved
};

TEST(ObjectHistoriesTest, ANameStandsForOneThingAndStaysWithIt) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 200 && !HasFailure(); ++seed) History(seed, &tally).Play(6);
  EXPECT_GT(tally.kept, 20000);
  EXPECT_GT(tally.followed, 200);
  EXPECT_GT(tally.returned, 20);
  EXPECT_GT(tally.swapped, 80);
  EXPECT_GT(tally.hidden, 2000);
  EXPECT_LT(tally.undecided, 0.05 * tally.followed);
  EXPECT_LT(tally.ambiguous, 0.01 * tally.looks);
}

}  // namespace
}  // namespace hires::sensing::object_histories_test
