#pragma once

namespace hires::base {

/// [s] processor time that the calling thread has used since it began.
double ThreadCpuSeconds();

/// [MB] (1e6 bytes) most memory that was ever resident in this process.
double PeakMegabytes();

}  // namespace hires::base
