#pragma once

namespace hires::lab {

/// Driven where imagination gave no answer [Rockel 2015, section 6.3.2]. The shipped domain has the
/// most cautious motion set there, so what is compared with the dissertation sets this one.
inline constexpr char kDissertationMotionSet[] = "fast";
inline constexpr char kDissertationDefaults[] = "motion_set=fast";  ///< for execution::ReadDefaults

}  // namespace hires::lab
