#pragma once

#include "execution/imagination_desk.h"
#include "execution/session.h"

namespace hires::execution {

/// Starts every step whose turn has come: those before it are done and their effects seen, what it
/// needs holds, its resources are free, and imagination has told its arguments or is too late.
class StepDispatch {
 public:
  StepDispatch(Session* session, ImaginationDesk* desk) : session_(*session), desk_(*desk) {}
  void Run();

 private:
  bool Advance(int step);  ///< true if bookkeeping made others possible
  bool Holds(const StepRun& step) const;
  bool CanRun(int step) const;
  bool HasResources(int step) const;
  bool IsUndisturbed(int step) const;
  void Start(int step);

  Session& session_;
  ImaginationDesk& desk_;
};

}  // namespace hires::execution
