#pragma once

namespace hires::evaluation {

struct Backends;

/// `hires doctor`: looks at the package's files and the machine, then compares the physics with
/// closed forms. Prints one line per check with what to do where it failed.
/// @return 0 if all passed, else kExitBadInput.
int RunDoctor(const Backends& backends);

}  // namespace hires::evaluation
