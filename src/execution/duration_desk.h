#pragma once

#include <optional>
#include <string>
#include <vector>

#include "execution/session.h"

namespace hires::execution {

/// In a dry run no step begins that would show how long it lasts. Those that can be imagined, and
/// of which the operators' data do not say what to expect (a drive from anywhere on the floor), are
/// imagined as they are planned, and of the answers the duration is taken alone.
class DurationDesk {
 public:
  explicit DurationDesk(Session* session) : session_(*session) {}

  /// Asks about the present plan, once. @pre the steps' arguments are settled.
  void Update();
  void OnAnswer(const ImagineAnswered& answer);
  void Close();  ///< nothing is asked any more
  /// In the notes of steps about which no answer came.
  void SayWhatIsUnknown();
  /// Whether no answer is awaited any more. @pre Update was called for the present plan.
  bool IsAnswered() const;
  std::optional<double> WakeAt() const;
  /// Of each step that was asked about and that nobody has imagined, "action: why".
  /// @pre SayWhatIsUnknown was called.
  const std::vector<std::string>& unimagined() const { return unimagined_; }

 private:
  struct Question {
    int step{-1};
    int request{0};
    double asked{0.0};  ///< [s]
  };

  bool IsUnknown(int step) const;
  void SayUnknown(int step, const std::string& why);
  void SayUnimagined(int step, const std::string& why);
  void Ask(int step);

  Session& session_;
  std::optional<int> plan_;          // number of the one that was asked about
  std::vector<Question> questions_;  // that are not answered
  std::vector<std::string> unimagined_;
};

}  // namespace hires::execution
