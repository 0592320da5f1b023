#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hires::knowledge::sparql {

/// In the text of a query, both counted from 1; columns are bytes.
struct Place {
  int line{1};
  int column{1};
};

struct Token {
  enum class Kind { kWord, kVariable, kName, kIri, kText, kNumber, kMark, kEnd };
  Kind kind{Kind::kEnd};
  /// As written, but without the brackets of an IRI and the quotes and escapes of a text. A
  /// variable has its `?`, also where it was written with `$`.
  std::string text;
  Place place;

  bool IsMark(std::string_view mark) const { return kind == Kind::kMark && text == mark; }
  bool IsWord(std::string_view lower_case) const;  ///< keywords compare without regard to case
};

/// @throws ConfigError "query LINE:COLUMN: ...".
[[noreturn]] void FailAt(Place place, const std::string& what);
/// For messages: what stands there, shortened.
std::string ToString(const Token& token);

/// Cuts a query into tokens, one at a time; comments and blanks are passed over.
class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}
  Token Next();

 private:
  bool AtEnd() const { return position_ == text_.size(); }
  char Peek(std::size_t ahead = 0) const;
  char Take();
  void SkipBlanks();
  std::string TakeWhile(bool (*fits)(char));
  void TakeVariable(Token* token);
  void TakeIri(Token* token);
  void TakeText(Token* token);
  void TakeNumber(Token* token);
  void TakeName(Token* token);
  void TakeMark(Token* token);
  char TakeEscape();

  std::string_view text_;
  std::size_t position_{0};
  Place place_;
};

}  // namespace hires::knowledge::sparql
