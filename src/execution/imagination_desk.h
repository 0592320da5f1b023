#pragma once

#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "execution/session.h"

namespace hires::execution {

/// For each `!imagine` step the step that it informs: the next one of that name whose arguments are
/// among the alternatives; -1: there is none, or the step does not imagine.
std::vector<int> InformedSteps(const PlanRun& run);

/// Looks after the `!imagine` steps of the plan: asks as soon as the state is known in which the
/// imagined step will start, asks again when it changes, moves deadlines with the plan, and brings
/// in the answers. Where there is none in time, a step keeps what was chosen for the same action
/// and alternatives before the plan was repaired, else it takes the defaults.
class ImaginationDesk {
 public:
  explicit ImaginationDesk(Session* session) : session_(*session) {}

  void Open();   ///< a plan was adopted; questions of the last one go on where they are the same
  void Close();  ///< nothing is asked any more
  void OnAnswer(const ImagineAnswered& answer);
  void OnChanged(const GeometryChanged& change);
  void Update();
  /// Whether nothing is waited for any more before the step begins, which could begin now.
  bool MayStart(int step);
  /// The step begins: where there is no answer it takes the last choice, else the defaults.
  void Settle(int step);
  /// Whether no answer is awaited any more, also for steps whose turn has not come. Where nobody
  /// can answer, that is one.
  bool IsAnswered() const;
  void SettleAll();  ///< as if every step began
  /// Of each question whose action makes no sense, "action: why".
  std::vector<std::string> Invalid() const;
  /// Likewise of each that nobody has imagined. @pre all are settled.
  std::vector<std::string> Unimagined() const;
  std::optional<double> WakeAt() const;

 private:
  struct Question {
    int step{-1};    ///< the `!imagine` step
    int target{-1};  ///< the step that it informs
    base::ActionTemplate action;
    planning::OnLate on_late{planning::OnLate::kDefault};
    bool is_open{true};  ///< its step has not begun
    bool is_hopeless{false};
    bool is_invalid{false};  ///< hopeless, as the action makes no sense
    /// The answer says that it does not know. Asking the same again until it does would take chance
    /// for knowledge; so it counts as late, until something changes.
    std::optional<ImagineAnswered> undecided;
    int request{0};               ///< under way; 0: none
    std::set<std::string> start;  ///< what changes of the state in which the step will start
    std::set<std::string> known;  ///< instances when it was asked
    double deadline{std::numeric_limits<double>::infinity()};
    std::optional<double> asked;    ///< [s] for the first time
    double since{0.0};              ///< [s] asked for the first time for this start
    std::optional<double> retry;    ///< [s] not before
    std::optional<double> limit;    ///< [s] the step waits for nothing else, and not beyond this
    std::optional<double> differs;  ///< [s] since when the start is another one
    std::optional<ImagineAnswered> answer;
    std::string why_not;  ///< why there is no answer yet
  };

  Question* FindTarget(int step);
  bool IsWorthAsking(const Question& question);
  void TakeOver(std::vector<Question>* old, Question* question);
  std::set<std::string> StartOf(const Facts& projected) const;
  bool HasChanged(Question* question);
  void Ask(Question* question);
  void AskAgain(Question* question, const std::string& why);
  void Cancel(Question* question);
  void MoveTo(Question* question, double deadline);
  double DeadlineOf(const Question& question);
  double LimitOf(const Question& question) const;
  int FirstRequestFor(const base::ActionTemplate& action, int request);
  void TakeRanked(Question* question);
  void TakeFailed(Question* question, const ImagineAnswered& answer);
  bool TakeChosen(const Question& question);
  void TakeDefaults(Question* question);
  void SetDefaults(const Question& question);
  bool IsCarried(const std::string& instance) const;
  bool IsAffected(const Question& question, const std::set<std::string>& changed) const;

  Session& session_;
  std::vector<Question> questions_;
  std::map<std::string, int> first_requests_;  // by action
  /// What was recommended last for an action of this task. A step that is planned again keeps it
  /// until there is a new answer.
  std::map<std::string, base::ActionCall> chosen_;
};

}  // namespace hires::execution
