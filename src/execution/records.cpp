#include "execution/records.h"

#include "hires/actions/action_spec.h"

namespace hires::execution {
namespace {

Record About(Record::Kind kind, const std::string& concept_name, const std::string& general,
             const std::string& instance) {
  Record record;
  record.kind = kind;
  record.concept_name = concept_name;
  record.general_concept = general;
  record.instance = instance;
  return record;
}

void AddAction(const base::ActionCall& action, Record* record) {
  record->texts.emplace_back("hasAction", action.name);
  for (const std::string& argument : action.arguments) {
    record->texts.emplace_back("hasArgument", argument);
  }
}

void AddFailure(const base::Failure& failure, Record* record) {
  if (!failure) return;
  record->texts.emplace_back("hasFailure", ToString(failure.code));
  for (const std::string& subject : failure.subjects) {
    record->texts.emplace_back("hasSubject", subject);
  }
  if (!failure.detail.empty()) record->texts.emplace_back("hasDetail", failure.detail);
}

Record OfTask(Record::Kind kind, int plan, int step, const base::ActionCall& action) {
  Record record =
      About(kind, actions::TaskConcept(action.name), "PrimitiveTask", TaskInstance(plan, step));
  AddAction(action, &record);
  record.numbers.emplace_back("hasIndex", step + 1);
  record.links.emplace_back("hasPlan", PlanInstance(plan));
  return record;
}

Record OfActivity(Record::Kind kind, int activity, const base::ActionCall& action) {
  Record record = About(kind, actions::ActivityConcept(action.name), "ElementaryRobotActivity",
                        "activity" + std::to_string(activity));
  AddAction(action, &record);
  return record;
}

}  // namespace

std::string PlanInstance(int plan) { return "plan" + std::to_string(plan); }

std::string TaskInstance(int plan, int step) {
  return PlanInstance(plan) + "Task" + std::to_string(step + 1);
}

Record PlanBegun(int plan, const std::string& task, double cost) {
  Record record = About(Record::Kind::kBegin, "Plan", "Plan", PlanInstance(plan));
  record.texts.emplace_back("hasTaskText", task);
  record.numbers.emplace_back("hasCost", cost);
  return record;
}

Record PlanEnded(int plan, const std::string& outcome) {
  Record record = About(Record::Kind::kEnd, "Plan", "Plan", PlanInstance(plan));
  record.texts.emplace_back("hasReason", outcome);
  return record;
}

Record TaskPlanned(int plan, int step, const base::ActionCall& action) {
  return OfTask(Record::Kind::kBegin, plan, step, action);
}

Record TaskChanged(int plan, int step, const base::ActionCall& action) {
  return OfTask(Record::Kind::kUpdate, plan, step, action);
}

Record ActivityBegun(int activity, int plan, int step, const base::ActionCall& action) {
  Record record = OfActivity(Record::Kind::kBegin, activity, action);
  record.links.emplace_back("hasTask", TaskInstance(plan, step));
  return record;
}

Record ActivityEnded(int activity, const base::ActionCall& action, const std::string& result,
                     const base::Failure& failure) {
  Record record = OfActivity(Record::Kind::kEnd, activity, action);
  record.texts.emplace_back("hasResult", result);
  AddFailure(failure, &record);
  return record;
}

Record Predicted(int number, int plan, int step, const base::ActionCall& action, double duration) {
  Record record = About(Record::Kind::kBegin, "Prediction", "Prediction",
                        "prediction" + std::to_string(number));
  AddAction(action, &record);
  record.numbers.emplace_back("hasExpectedDuration", duration);
  record.numbers.emplace_back("hasRecommendation", 1.0);
  record.links.emplace_back("hasTask", TaskInstance(plan, step));
  return record;
}

Record FailureImagined(int number, int plan, int step, const base::ActionCall& action,
                       const base::Failure& failure) {
  Record record = About(Record::Kind::kBegin, "ImaginedFailure", "Prediction",
                        "prediction" + std::to_string(number));
  AddAction(action, &record);
  AddFailure(failure, &record);
  record.links.emplace_back("hasTask", TaskInstance(plan, step));
  return record;
}

Record FailureForgotten(int number, const base::ActionCall& action) {
  Record record = About(Record::Kind::kEnd, "ImaginedFailure", "Prediction",
                        "prediction" + std::to_string(number));
  AddAction(action, &record);
  return record;
}

Record Failed(int number, const std::string& concept_name, int activity,
              const base::ActionCall& action, const base::Failure& failure) {
  Record record = About(Record::Kind::kBegin, concept_name, "MonitoredFailure",
                        "failure" + std::to_string(number));
  AddAction(action, &record);
  AddFailure(failure, &record);
  if (activity > 0) {
    record.links.emplace_back("hasActivity", "activity" + std::to_string(activity));
  }
  return record;
}

}  // namespace hires::execution
