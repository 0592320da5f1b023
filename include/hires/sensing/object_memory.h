#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hires/perception/detector.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/sensing/body_reading.h"
#include "hires/sensing/tray_objects.h"

namespace hires::sensing {

struct MemoryParams {
  double expected_share{0.6};     ///< of an object's surface that must be free before it counts as
                                  ///< missed in a look that does not detect it
  double expected_margin{0.06};   ///< [m] so far beside where it is believed it must be free, too:
                                  ///< what hides it was seen from elsewhere, or by another error
  double expected_size{0.0012};   ///< [sr] of what is free of it, as seen by the camera: smaller
                                  ///< things may be overlooked ...
  double expected_distance{2.0};  ///< [m] ... and those that are farther away
  int looks_to_vanish{3};         ///< in a row in which it was missed
  double blending{0.3};           ///< weight of a new sight of an object that stands still
  double moved_distance{0.04};    ///< [m] beyond which it has moved, and the new sight alone counts
  double moved_angle{0.3};        ///< [rad] likewise
  double grasp_distance{0.12};    ///< [m] from between the finger tips to an object that they hold
  double closed_gap{0.005};       ///< [m] a gripper that has closed so far holds nothing
  double gap_below{0.02};         ///< [m] that a gap may be narrower than what it holds
  double gap_above{0.012};        ///< [m] that it may be wider: what is held may stand aslant
                                  ///< between the fingers, whose gap errs by up to 3 mm itself
  double open_gap{0.0025};        ///< [m] from its limit a gripper is open and holds nothing
  double opening{0.006};          ///< [m] by which a gap opens when it lets go
  double still_gap{0.0015};       ///< [m] that a gap may change and count as still
  double still_time{0.15};        ///< [s] after which it is
  double hand_distance{0.08};  ///< [m] between where a held object should be and where it is seen
  double instance_distance{0.1};  ///< [m] from where an object is expected within which a thing of
                                  ///< its kind, that has no name, is taken for it
  double told_distance{0.5};      ///< [m] likewise, in several looks, of what nobody has seen yet
  double instance_margin{0.03};   ///< [m] by which the best way to name all things must be better
  int looks_to_appear{3};         ///< in a row in which a thing that is none of the known is seen
  int scans_to_vanish{5};         ///< of the tray in a row that look through what should be there
  int scans_to_appear{20};        ///< in a row that see a thing there that nobody knows
  bool operator==(const MemoryParams& other) const;
};

struct RememberedObject {
  std::string name;  ///< lower case
  std::string model;
  std::string link;  ///< of the robot, that it moves with: the palm that holds it, or the base
                     ///< when it stands on the tray; empty: the map
  bool is_held{false};
  bool is_observed{false};  ///< seen or felt; else hearsay
  geometry::Pose3 X_LO;     ///< in the frame of `link`
  double time{0.0};         ///< [s] when it was seen last
  int num_missed{0};        ///< looks in a row
  int num_resized{0};       ///< looks in a row that measured another box of a thing of unknown kind
  int num_looked_through{0};  ///< scans of the tray in a row that saw nothing in its place
  int num_points{0};  ///< most that a look showed of it, where looks alone tell its kind, or find
                      ///< none; else 0
};

/// A scan of the tray and what it says.
struct TrayView {
  double time{0.0};      ///< [s]
  geometry::Pose3 X_BT;  ///< the tray in the robot's base
  double height{0.0};    ///< [m] of the scan over the tray's frame
  TrayReading reading;
};

/// What the robot knows of loose objects from looking and from its fingers: where they are, what it
/// holds, what is not where it was any more. Knows no clock; same input, same output.
///
/// A hand holds an object when its gap has come to rest, not open, at about the object's width,
/// with the object between the finger tips by what was seen last; it has let go when the gap opens,
/// and lost it when the gap closes further, or when the object is seen elsewhere. What is held
/// moves with the palm, what is over the tray moves with the base. An object vanishes when the
/// place where it should be was free to look at in several looks in a row, and it was not detected;
/// one that slipped out of the hand at once.
///
/// Things whose recogniser knows their kind alone are given to the remembered objects of their
/// kinds near them, all at once (AnchorThings); where another way is nearly as good they say only
/// that something of the kind is there, so that what is remembered there does not count as missed.
/// What stays alone in several looks is a vanished object of its kind that was moved, or one that
/// was never seen and is said to be not far away, or else one that nobody knew: it gets the first
/// free name (mug3).
///
/// What no model explains, and is not where something is expected, is remembered by its box: its
/// model says it (world::UnknownBoxModel), its name is unknown1, unknown2, ... It has no identity
/// beyond its place; where something known turns out to be in its place, it was that. Where the
/// table may end before it, it may be furniture, which no look would ever miss: it is only counted.
/// Where looks alone said of what kind a thing is, several in a row that show more of it, and find
/// that no model explains it, know better: from afar a box may look like a book.
///
/// A laser over the tray says where what stands there is, what is gone, and that something is there
/// that nobody knows. It tells nothing of heights and leaning, nor who something is: none of its
/// scans counts as a sight of what is known (RememberedObject::time).
class ObjectMemory {
 public:
  ObjectMemory(std::shared_ptr<const perception::Surroundings> surroundings,
               std::shared_ptr<const robot::Robot> robot, const MemoryParams& params = {});

  /// Hearsay: where an object is said to be. Counts only as long as nothing was observed of it.
  /// @throws base::ConfigError for a model that the world, or a link that the robot does not have.
  void Believe(const std::string& name, const std::string& model, const std::string& link,
               const geometry::Pose3& X_LO);
  /// That is not said any more.
  void Disbelieve(const std::string& name);
  /// Only these objects are still spoken of.
  void DisbelieveAllBut(const std::vector<std::string>& names);

  /// @return whether a hand took, let go or lost something.
  /// @throws base::ConfigError as robot::ForwardKinematics, where the place of a hand matters.
  bool Feel(const BodyReading& body);
  /// @throws base::ConfigError for what Look would refuse: a label that is no model of the world, a
  /// pose that is no number, a box beyond 10 m.
  void Check(const perception::Detection& detection) const;
  /// One look of the robot's camera; an empty list says that nothing was seen.
  /// @param table_C  corners in the camera's frame of what was looked at, counter-clockwise from
  ///                 above: nothing that is elsewhere is missed. Empty: all that is in view.
  /// @pre the robot has a camera.
  /// @throws base::ConfigError as Feel and Check; nothing is remembered of such a look.
  void Look(const BodyReading& body, const std::vector<perception::Detection>& detections,
            const std::vector<Eigen::Vector3d>& table_C = {});

  /// One scan of the laser over the tray. What stands in its place is put where its beams say, what
  /// stands elsewhere on the tray goes there, and what several scans in a row look through has
  /// vanished. A thing that no object explains is remembered as one of unknown kind: as wide as it
  /// is seen and some, as deep as it is wide or kDepthOnTray where one side alone is seen,
  /// kHeightOnTray high.
  /// Where something hides its place, and where the robot's own parts or what it holds are in the
  /// scan, nothing is concluded.
  /// @param X_BL  the laser in the robot's base.
  /// @return why it was not used; empty: it was.
  /// @throws base::ConfigError as Feel.
  std::string ScanTray(const BodyReading& body, const robot::ScanReading& scan,
                       const geometry::Pose3& X_BL);
  static constexpr double kDepthOnTray = 0.08;   ///< [m]
  static constexpr double kHeightOnTray = 0.15;  ///< [m]
  /// The last scan of the tray that was used.
  const std::optional<TrayView>& tray() const { return tray_; }

  const std::map<std::string, RememberedObject>& objects() const { return objects_; }
  /// Objects whose place was looked at in vain, or that slipped away: until they are seen again.
  std::vector<std::string> Vanished() const;
  /// Things of the last look that may be either of several objects.
  int num_ambiguous() const { return num_ambiguous_; }
  /// Things of the last look, of any kind, that may be beside the table (Detection::may_be_beside).
  int num_beside() const { return num_beside_; }
  /// Things of the last look of which more looks must tell what they are: none of the known, and
  /// without a name yet, or ambiguous.
  int num_newcomers() const;
  /// Everything that is known to be somewhere, in the map; what is held is attached to its palm.
  std::vector<robot::SeenObject> Known(const BodyReading& body) const;

 private:
  /// A thing that is none of the known.
  struct Newcomer {
    std::string kind;
    Eigen::Vector3d p_M;
    int num_looks{0};   ///< in a row
    int detection{-1};  ///< of this look
  };
  struct Hand {
    double gap{-1.0};   ///< [m] at which it has been still; negative: not felt yet
    double since{0.0};  ///< [s]
    std::string holds;
    double grasp_gap{0.0};  ///< [m] when it took hold
  };
  class Links;

  bool FeelHand(const Links& links, const std::string& arm, Hand* hand, const BodyReading& body);
  std::string Between(const Links& links, const robot::ArmProfile& arm, double gap) const;
  void Take(const Links& links, const robot::ArmProfile& arm, const std::string& name, Hand* hand);
  bool IsInHand(const Links& links, const RememberedObject& object,
                const geometry::Pose3& X_MO) const;
  void LetGo(const Links& links, const std::string& name, double time);
  void Lose(const Links& links, const std::string& name);
  struct Named;
  struct LookedAt;
  Eigen::Vector3d PlaceOf(const Links& links, const RememberedObject& object) const;
  std::vector<Named> NamesOf(const Links& links, const LookedAt& look) const;
  bool MayBe(const Links& links, const RememberedObject& object,
             const perception::Detection& detection, const geometry::Pose3& X_MO) const;
  bool MayBeNew(const Links& links, const perception::Detection& detection,
                const geometry::Pose3& X_MO) const;
  bool LiesIn(const Links& links, const RememberedObject& object,
              const geometry::Pose3& X_MO) const;
  std::vector<BelievedOnTray> BelievedOn(const Links& links, const geometry::Pose3& X_MT) const;
  std::vector<geometry::Polygon> OwnOutlines(const Links& links, const geometry::Pose3& X_MT,
                                             double height) const;
  void Agree(const Links& links, const TrayView& view, const geometry::Pose3& X_MT);
  void AppearOnTray(const Links& links, const TrayView& view, const geometry::Pose3& X_TL);
  void Appear(const Links& links, const LookedAt& look, std::vector<Named>* named);
  std::vector<std::string> ToldNear(const Links& links, const Newcomer& newcomer,
                                    const std::vector<Named>& named) const;
  bool MustWait(const Links& links, const LookedAt& look, const Newcomer& newcomer,
                const std::vector<Named>& named) const;
  void NameNewcomers(const Links& links, const LookedAt& look, std::vector<Named>* named);
  void Reveal(const Links& links, const LookedAt& look, const std::vector<Named>& named);
  std::string BoxOf(const Links& links, const std::string& name,
                    const perception::Detection& detection, geometry::Pose3* X_MO);
  std::string NewName(const std::string& kind, const Eigen::Vector3d& p_M) const;
  std::string FreeName(const std::string& kind) const;
  geometry::Pose3 TurnedAlike(const Links& links, const std::string& name, const std::string& model,
                              geometry::Pose3 X_MO) const;
  geometry::Pose3 AsHeld(const Links& links, const std::string& name,
                         const geometry::Pose3& X_MO) const;
  void See(const Links& links, const std::string& name, const std::string& label,
           const geometry::Pose3& X_MO, double time);
  double SizeInView(const perception::CameraView& view, const std::string& model,
                    const geometry::Pose3& X_MO) const;
  bool MustBeSeen(const perception::LineOfSight& sight, const LookedAt& look, const Links& links,
                  const RememberedObject& object) const;
  void Miss(const perception::LineOfSight& sight, const Links& links, const LookedAt& look,
            const std::vector<Named>& named);
  void PlaceAt(const Links& links, const geometry::Pose3& X_MO, RememberedObject* object) const;
  bool IsOverTray(const Links& links, const geometry::Pose3& X_MO) const;
  Hand* HandOf(const std::string& object);

  std::shared_ptr<const perception::Surroundings> surroundings_;
  std::shared_ptr<const robot::Robot> robot_;
  MemoryParams params_;
  std::optional<geometry::Aabb> tray_T_;  ///< plate, in the tray's frame
  std::map<std::string, RememberedObject> objects_;
  struct LastPlace {
    std::string model;
    Eigen::Vector3d p_M;  ///< where it was last
    int num_points;       ///< as remembered of it
  };
  std::map<std::string, LastPlace> vanished_;  ///< by name
  std::vector<Newcomer> newcomers_;
  struct NewOnTray {
    Eigen::Vector2d p_T;
    int num_scans{0};  ///< in a row
  };
  std::vector<NewOnTray> new_on_tray_;
  std::optional<TrayView> tray_;
  int num_ambiguous_{0}, num_beside_{0};
  std::map<std::string, Hand> hands_;  ///< by arm
};

}  // namespace hires::sensing
