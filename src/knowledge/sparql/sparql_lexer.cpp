#include "knowledge/sparql/sparql_lexer.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::knowledge::sparql {
namespace {

constexpr std::size_t kMaxExcerpt = 40;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80;
}
bool IsWordPart(char c) { return IsLetter(c) || IsDigit(c) || c == '_'; }
bool IsNamePart(char c) { return IsWordPart(c) || c == '-' || c == '.' || c == ':'; }
bool IsNumberPart(char c) { return IsWordPart(c) || c == '.' || c == '+' || c == '-'; }
bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Never cuts a character of several bytes in two; control characters would spoil a log line.
std::string Excerpt(const std::string& text) {
  std::size_t size = std::min(text.size(), kMaxExcerpt);
  while (size > 0 && size < text.size() &&
         (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80) {
    --size;
  }
  std::string excerpt = text.substr(0, size);
  for (char& c : excerpt) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  }
  return size < text.size() ? excerpt + "..." : excerpt;
}

}  // namespace

bool Token::IsWord(std::string_view lower_case) const {
  return kind == Kind::kWord && base::ToLower(text) == lower_case;
}

void FailAt(Place place, const std::string& what) {
  throw base::ConfigError(fmt::format("query {}:{}: {}", place.line, place.column, what));
}

std::string ToString(const Token& token) {
  if (token.kind == Token::Kind::kEnd) return "the end of the query";
  const std::string excerpt = Excerpt(token.text);
  if (token.kind == Token::Kind::kIri) return "'<" + excerpt + ">'";
  if (token.kind == Token::Kind::kText) return "the text \"" + excerpt + "\"";
  return "'" + excerpt + "'";
}

char Lexer::Peek(std::size_t ahead) const {
  return position_ + ahead < text_.size() ? text_[position_ + ahead] : '\0';
}

char Lexer::Take() {
  const char c = text_[position_++];
  if (c == '\n') {
    ++place_.line;
    place_.column = 1;
  } else {
    ++place_.column;
  }
  return c;
}

void Lexer::SkipBlanks() {
  while (!AtEnd() && (IsBlank(Peek()) || Peek() == '#')) {
    if (Take() != '#') continue;
    while (!AtEnd() && Peek() != '\n') Take();
  }
}

std::string Lexer::TakeWhile(bool (*fits)(char)) {
  std::string taken;
  while (!AtEnd() && fits(Peek())) taken += Take();
  return taken;
}

Token Lexer::Next() {
  SkipBlanks();
  Token token;
  token.place = place_;
  if (AtEnd()) return token;
  const char c = Peek();
  if (c == '?' || c == '$') {
    TakeVariable(&token);
  } else if (c == '<') {
    TakeIri(&token);
  } else if (c == '"' || c == '\'') {
    TakeText(&token);
  } else if (IsDigit(c) || ((c == '-' || c == '+' || c == '.') && IsDigit(Peek(1)))) {
    TakeNumber(&token);
  } else if (IsLetter(c) || c == ':' || c == '_') {
    TakeName(&token);
  } else {
    TakeMark(&token);
  }
  return token;
}

void Lexer::TakeVariable(Token* token) {
  Take();
  const std::string name = TakeWhile(&IsWordPart);
  if (name.empty()) FailAt(token->place, "came '?' alone, wanted the name of a variable after it");
  token->kind = Token::Kind::kVariable;
  token->text = "?" + name;
}

void Lexer::TakeIri(Token* token) {
  Take();
  token->kind = Token::Kind::kIri;
  token->text = TakeWhile([](char c) { return c != '>' && !IsBlank(c); });
  if (Peek() != '>') {
    FailAt(token->place, "came " + ToString(*token) + " without an end, wanted '>' after the IRI");
  }
  Take();
}

void Lexer::TakeText(Token* token) {
  const char quote = Take();
  token->kind = Token::Kind::kText;
  while (!AtEnd() && Peek() != quote && Peek() != '\n') {
    const char c = Take();
    token->text += c == '\\' ? TakeEscape() : c;
  }
  if (Peek() != quote) {
    FailAt(token->place,
           "came " + ToString(*token) + " without an end, wanted " + quote + " on the same line");
  }
  Take();
}

char Lexer::TakeEscape() {
  const Place place = place_;
  const char c = AtEnd() ? '\0' : Take();
  if (c == 'n') return '\n';
  if (c == 't') return '\t';
  if (c == 'r') return '\r';
  if (c == '\\' || c == '"' || c == '\'') return c;
  FailAt(place, "came an unknown escape in a text, wanted one of \\n \\t \\r \\\\ \\\" \\'");
}

void Lexer::TakeNumber(Token* token) {
  token->kind = Token::Kind::kNumber;
  token->text = TakeWhile(&IsNumberPart);
  if (token->text.back() != '.') return;  // a dot at the end ends the pattern
  token->text.pop_back();
  --position_;
  --place_.column;
}

void Lexer::TakeName(Token* token) {
  token->text = TakeWhile(&IsNamePart);
  while (token->text.back() == '.') {  // likewise
    token->text.pop_back();
    --position_;
    --place_.column;
  }
  const bool has_prefix = token->text.find(':') != std::string::npos;
  token->kind = has_prefix ? Token::Kind::kName : Token::Kind::kWord;
}

void Lexer::TakeMark(Token* token) {
  token->kind = Token::Kind::kMark;
  token->text = Take();
  if (token->text == "^" && Peek() == '^') token->text += Take();
}

}  // namespace hires::knowledge::sparql
