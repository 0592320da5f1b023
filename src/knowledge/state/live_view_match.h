#pragma once

#include <string_view>

#include "hires/knowledge/fluent.h"

namespace hires::knowledge {

/// Names of instances compare without regard to the case of ASCII letters.
bool SameName(std::string_view a, std::string_view b);
bool NameLess(std::string_view a, std::string_view b);

bool IsNumber(const Filler& filler);
double AsDouble(const Filler& number);  ///< @pre IsNumber(number)
/// Text without regard to case; 1 and 1.0 are the same; a truth value is no number.
bool SameFiller(const Filler& a, const Filler& b);

}  // namespace hires::knowledge
