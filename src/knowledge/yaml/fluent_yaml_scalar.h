#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hires::knowledge {

/// What an unquoted scalar is to a reader of YAML 1.1, whatever was meant.
enum class PlainMeaning { kText, kTruth, kNull, kNumber };
PlainMeaning MeaningOf(std::string_view plain);

/// "true", "True", "TRUE" and the same of "false"; empty for anything else.
std::optional<bool> ReadTruth(std::string_view plain);

/// Decimal numbers as YAML 1.1 and 1.2 agree on them: no hexadecimals, no octals (010), no `1_000`,
/// no 1:30. `kTooLarge`: a number, beyond the type's range.
enum class NumberOutcome { kRead, kNoNumber, kTooLarge };
NumberOutcome ReadReal(std::string_view plain, double* value);
NumberOutcome ReadInteger(std::string_view plain, std::int64_t* value);

/// The shortest decimal that reads back as the same bits, with a point, so that every YAML reader
/// takes it for a float: 5.0, 1.0e+22, .inf.  @pre not NaN.
std::string WriteReal(double value);

/// Plain where no YAML reader could take it for anything but text, else in double quotes, on one
/// line.
std::string WriteText(std::string_view text);

}  // namespace hires::knowledge
