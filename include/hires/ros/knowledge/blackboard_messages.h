#pragma once

#include <hires/Assertion.h>
#include <hires/BlackboardError.h>
#include <hires/DemandRequest.h>
#include <hires/Episode.h>
#include <hires/Fluent.h>
#include <hires/FluentChange.h>
#include <hires/FluentChanges.h>
#include <hires/FluentQuery.h>

#include <string>
#include <vector>

#include "hires/knowledge/demand.h"
#include "hires/knowledge/fluent.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/query.h"
#include "hires/knowledge/store.h"

/// Messages of the Blackboard and what they stand for. Reading throws hires::base::ConfigError that
/// names the field.
namespace hires_ros {

/// Bounds of 0, 0 mean that there is no bound, the moment 0 is -0.0, -0.0.
hires::knowledge::Fluent FromMessage(const hires::Fluent& message);
hires::Fluent ToMessage(const hires::knowledge::Fluent& fluent);
std::vector<hires::knowledge::Fluent> FromMessages(const std::vector<hires::Fluent>& messages);
std::vector<hires::Fluent> ToMessages(const std::vector<hires::knowledge::Fluent>& fluents);

/// A time of 0 stays 0: only the node knows what "now" is.
hires::knowledge::Assertion FromMessage(const hires::Assertion& message);
hires::Assertion ToMessage(const hires::knowledge::Assertion& assertion);

hires::knowledge::Episode FromMessage(const hires::Episode& message);
hires::Episode ToMessage(const hires::knowledge::Episode& episode);

hires::knowledge::FluentQuery FromMessage(const hires::FluentQuery& message);
hires::FluentQuery ToMessage(const hires::knowledge::FluentQuery& query);

hires::knowledge::Change FromMessage(const hires::FluentChange& message);
hires::FluentChange ToMessage(const hires::knowledge::Change& change);
/// `previous` is filled by the publisher.
hires::FluentChanges ToMessage(const hires::knowledge::DemandUpdate& update);

hires::knowledge::DemandTopic FromMessage(const hires::DemandRequest& message);

}  // namespace hires_ros
