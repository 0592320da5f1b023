#include "reports/experience/experience_writer.h"

#include <utility>

#include "hires/base/error.h"

namespace hires::reports {

using knowledge::ToppleState;

ExperienceWriter::ExperienceWriter(knowledge::ExperienceStore* store, std::string run)
    : store_(store) {
  batch_.run = std::move(run);
}

ExperienceWriter::~ExperienceWriter() { Flush(); }

void ExperienceWriter::SetAction(const std::string& action) {
  if (action == batch_.action) return;
  Flush();
  batch_.action = action;
}

void ExperienceWriter::SetRun(const std::string& run) {
  if (run == batch_.run) return;
  Flush();
  batch_.run = run;
}

void ExperienceWriter::Add(const knowledge::ToppleEpisodePart& part) {
  batch_.parts.push_back(part);
  const bool has_toppled = part.state == ToppleState::kTopple && last_ != ToppleState::kTopple;
  last_ = part.state;
  const bool is_due = has_toppled || batch_.parts.size() >= kBatch;
  if (is_due && problem_.empty()) Flush();  // else only who asks waits for a file that is locked
}

void ExperienceWriter::Flush() {
  if (!batch_.parts.empty()) {
    waiting_.push_back(batch_);
    batch_.parts.clear();
  }
  problem_.clear();
  while (!waiting_.empty()) {
    try {
      store_->Write(waiting_.front());
    } catch (const base::ConfigError& error) {
      problem_ = error.what();
      break;
    }
    num_written_ += waiting_.front().parts.size();
    waiting_.pop_front();
  }
  while (waiting_.size() > kMostKept) {
    num_lost_ += waiting_.front().parts.size();
    waiting_.pop_front();
  }
}

}  // namespace hires::reports
