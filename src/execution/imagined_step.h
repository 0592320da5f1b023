#pragma once

#include <string>

#include "execution/session.h"

// What is common to all questions that imagination is asked about a step.

namespace hires::execution {

/// The present state with the effects of what runs and of what comes before the step in the plan.
Facts ProjectedTo(const Session& session, int step);

/// The plan expects of a step what imagination found that it lasts. Where that contradicts the
/// bounds of the plan, these stay, and it is said.
/// @pre the answer is kRanked.
void ExpectAsImagined(const ImagineAnswered& answer, int step, Session* session);

/// Nobody has imagined it; an answer that is undecided, or finds it to be senseless, is one.
bool IsUnimagined(ImagineAnswered::Outcome outcome);

/// Why an answer other than kRanked recommends nothing; for people.
std::string WhyNothing(const ImagineAnswered& answer);

}  // namespace hires::execution
