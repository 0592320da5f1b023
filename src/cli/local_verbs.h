#pragma once

#include "cli/verb_table.h"
#include "cli/verbs/doctor/doctor.h"
#include "cli/verbs/imagine/imagine_query.h"
#include "cli/verbs/list/list_command.h"

// Verbs that need no Blackboard, no planner of tasks and no node; so a small program has them,
// which is built long before `hires` is.
namespace hires::cli {

void AddImagine(const ImagineBackends& backends, VerbTable* table);
void AddLimits(VerbTable* table);
/// @param tasks  none: this program does not plan, and lists no tasks.
void AddList(const TaskLister& tasks, VerbTable* table);
void AddNew(VerbTable* table);
void AddDoctor(const DoctorBackends& backends, VerbTable* table);

/// The program `hires_local`, which has these verbs alone and asks nobody. Never throws.
/// @param arguments       the program's name first, as in argv.
/// @param package_folder  where config/, worlds/, urdf/ lie.
int RunLocalCommandLine(const std::vector<std::string>& arguments,
                        const std::string& package_folder);

}  // namespace hires::cli
