#pragma once

#include "hires/execution/monitor.h"
#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"

namespace hires::loop {

/// The fluent that a record stands for, since `start` [s] main ROS time. An ontology that does not
/// know its concept has the general one. Types of the fillers are those of the ontology; what it
/// does not know is left for the Blackboard to refuse.
knowledge::Fluent FluentOf(const execution::Record& record, double start,
                           const knowledge::Ontology& ontology);

}  // namespace hires::loop
