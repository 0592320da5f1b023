#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/src/trial/random_tables.h"

namespace hires::perception {

/// By how much the box that an unknown thing is said to have differs from the box around it. [m]
struct BoxError {
  double middle{0.0};   ///< from one box's middle to the other's, by the sensor alone
  double longer{0.0};   ///< longer side from above, less what it is; positive: told too long
  double shorter{0.0};  ///< shorter side from above, likewise
  double height{0.0};   ///< likewise
};

/// What became of a thing that stood on a table.
struct ThingVerdict {
  int table{0};          ///< on which one it stood, of those that a score has
  std::string model{};   ///< its own label
  std::string kind{};    ///< the first label of its geometry; unknown, if it is
  double distance{0.0};  ///< [m] from the camera to its foot
  int torso{0};          ///< as RandomTable
  ThingInView view{};
  int num_points{0};
  std::string called{};    ///< likewise; empty: not found
  std::string label{};     ///< by what label, of those that look so
  bool is_merged{false};   ///< ... because it was taken for a part of another thing
  double confidence{0.0};  ///< in what it is called
  double doubt{0.0};       ///< confidence in what it is, where it is called otherwise
  Eigen::Vector3d offset{Eigen::Vector3d::Zero()};  ///< [m] of its pose, along SightFrame's columns
  double error{0.0};                  ///< [m] of its pose, of one that is called rightly and known
  double error_B{0.0};                ///< [m] likewise in the robot's base, with its camera's mount
  std::optional<double> turned_by{};  ///< [rad] likewise; nothing: it looks the same all around
  std::optional<BoxError> box{};      ///< of an unknown one that is called so

  bool is_known() const { return kind != kUnknownLabel; }
  bool is_found() const { return !called.empty(); }
  bool is_right() const { return called == kind; }
};

/// By what detection a thing is found: one that has more of it than of any other thing and, at
/// least, these shares.
struct FoundBy {
  double of_thing{0.5};      ///< of the points that the camera measured of the thing
  double of_detection{0.5};  ///< of the detection's points that are the thing's
};
/// Those by which a robot is told of a thing, however little of it they have.
inline constexpr FoundBy kToldOf{0.0, 0.0};

/// How what was recognised on tables agrees with what stood there: what is found (FoundBy), and
/// called rightly, by the name of any model of its geometry. Things of too few pixels do not count.
class RecognitionScore {
 public:
  explicit RecognitionScore(const std::vector<KnownModel>& catalogue, int min_points = 400,
                            const FoundBy& found_by = {});

  /// @param seen  as LookAtTable gives it.
  void Add(const RandomTable& table, const TabletopView& seen);
  /// What another one has, behind what this one has.
  void Append(const RecognitionScore& other);

  const std::vector<ThingVerdict>& things() const { return things_; }
  /// All labels of that geometry; one of no known kind has its own.
  std::vector<std::string> LabelsLike(const std::string& label) const;
  int num_detections() const { return num_detections_; }
  int num_surplus() const { return num_surplus_; }  ///< by which no thing is found

 private:
  struct Kind {
    std::vector<std::string> labels;  // of one geometry
    int symmetry;                     // TurnSymmetry
  };
  const Kind* FindKind(const std::string& label) const;
  std::string KindOf(const std::string& label) const;
  void JudgePose(const RandomTable& table, const TableThing& thing, const Detection& seen,
                 ThingVerdict* verdict) const;
  void JudgeName(const Detection& seen, ThingVerdict* verdict) const;

  int min_points_;
  FoundBy found_by_;
  std::vector<Kind> kinds_;
  std::vector<ThingVerdict> things_;
  int num_tables_{0}, num_detections_{0}, num_surplus_{0};
};

/// Of absolute values; not a number where there are none. [m]
struct ErrorQuantiles {
  double median{0.0};
  double share_95{0.0};  ///< 95 % are no larger
};

/// Boxes of unknown things that are called so.
struct BoxSums {
  int num_boxes{0};
  ErrorQuantiles middle{}, longer{}, shorter{}, height{};
};

/// Sums of verdicts. Quantiles of nothing are not a number.
struct RecognitionSums {
  int num_things{0}, num_found{0};
  int num_known{0}, num_known_found{0};
  int num_named{0};      ///< rightly, up to equal geometry
  int num_own_label{0};  ///< ... by their own label
  int num_unknown{0}, num_unknown_found{0}, num_unknown_so_called{0};
  double median_error{0.0}, error_95{0.0};  ///< [m] of what is named rightly, by the sensor alone
  double median_error_B{0.0}, error_B_95{0.0};  ///< [m] ... with the error of the camera's mount
  double median_turn{0.0};                      ///< [rad] of what does not look the same all round
  BoxSums boxes{};
};
RecognitionSums SumsOf(const std::vector<ThingVerdict>& things);

/// One line for people, with what was confused.
std::string Text(const RecognitionScore& score);

}  // namespace hires::perception
