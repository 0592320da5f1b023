#pragma once

#include <string>

#include "hires/execution/monitor.h"

namespace hires::execution {

/// Instances are numbered through and never come twice in the life of a monitor: "plan3",
/// "plan3Task2" (counting from 1), "activity17", "prediction4", "failure5".
std::string PlanInstance(int plan);
std::string TaskInstance(int plan, int step);

Record PlanBegun(int plan, const std::string& task, double cost);
Record PlanEnded(int plan, const std::string& outcome);
Record TaskPlanned(int plan, int step, const base::ActionCall& action);
Record TaskChanged(int plan, int step, const base::ActionCall& action);

Record ActivityBegun(int activity, int plan, int step, const base::ActionCall& action);
Record ActivityEnded(int activity, const base::ActionCall& action, const std::string& result,
                     const base::Failure& failure);

/// What imagination says about an alternative.
Record Predicted(int number, int plan, int step, const base::ActionCall& action, double duration);
Record FailureImagined(int number, int plan, int step, const base::ActionCall& action,
                       const base::Failure& failure);

/// It counts no more: what it rested on changed, or the task is over.
Record FailureForgotten(int number, const base::ActionCall& action);

/// @param concept_name  "PreconditionFailure", ...
/// @param activity      0: none
Record Failed(int number, const std::string& concept_name, int activity,
              const base::ActionCall& action, const base::Failure& failure);

}  // namespace hires::execution
