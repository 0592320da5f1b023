#pragma once

#include <string>
#include <vector>

namespace hires::physics {

/// Prepares ODE for the calling thread: the library once per process, its collision scratch memory
/// once per thread (given back when the thread ends). From then on ODE's messages are collected per
/// thread, and its errors, after which it would end the process, are thrown as std::logic_error.
void EnsureOdeIsReady();

/// What ODE said in this thread since the last call, oldest first. Of a flood the first hundred are
/// kept and the rest is counted in a last line.
std::vector<std::string> TakeOdeMessages();

}  // namespace hires::physics
