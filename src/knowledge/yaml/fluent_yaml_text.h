#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace hires::knowledge {

/// The text of one YAML document within a stream.
struct DocumentText {
  std::string_view text;
  int first_line{1};  ///< in the stream, counted from 1
};

/// Cuts a YAML stream at its document markers, before any YAML is parsed, so that what the parser
/// holds at a time is bounded.
class DocumentSplitter {
 public:
  /// @param text    Must outlive this.
  /// @param source  Stands for the file name in messages.
  /// @throws ConfigError naming the line where `text` is no UTF-8, holds control characters, or is
  ///   larger than 64 MB.
  DocumentSplitter(std::string_view text, std::string source);

  /// The next document that holds more than comments; empty at the end.
  /// @throws ConfigError naming the line where a document begins that has too much punctuation.
  std::optional<DocumentText> Next();

  /// Number of the document that Next() gave last; those without content count as well.
  int number() const { return number_; }

 private:
  std::string_view Line() const;
  void Pass(std::string_view line);

  std::string_view rest_;  // not yet given out
  std::string source_;
  int line_{1};  // of the first character of rest_
  int number_{0};
};

/// Text for messages: at most 60 bytes, whole characters, no line breaks.
std::string Shown(std::string_view text);

}  // namespace hires::knowledge
