#include "hires/planning/datum_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <utility>

#include "hires/base/error.h"
#include "planning/language/datum_text.h"

namespace hires::planning {
namespace {

constexpr std::size_t kMaxExcerpt = 60;

std::string Cut(std::string_view text, std::size_t at_most) {
  if (text.size() <= at_most) return std::string(text);
  const std::string_view start = text.substr(0, at_most - 3);
  return std::string(start.substr(0, ValidUtf8Length(start))) + "...";
}

bool IsBlank(char c) { return std::string_view(" \t\n\r\f\v").find(c) != std::string_view::npos; }
bool IsControl(char c) {
  return (static_cast<unsigned char>(c) < ' ' && !IsBlank(c)) || c == '\x7f';
}
/// Letters of ASCII alone, whatever the locale.
char ToLowerAscii(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// A list or a quote whose end has not come yet.
struct Open {
  /// kRequired, kForbidden: the feature after `#+`, `#-`. kSkipped: what is left out.
  enum class Wants { kItems, kTail, kEnd, kQuoted, kRequired, kForbidden, kSkipped };
  Datum list;
  Wants wants{Wants::kItems};

  bool IsList() const { return wants <= Wants::kEnd; }
};

/// Of a program that is no Lisp and has none.
bool HasFeature(const Datum& feature) {
  const std::string_view head = feature.Head();
  const auto begin = feature.items.begin() + (feature.items.empty() ? 0 : 1);
  if (head == "and" || head == ":and") return std::all_of(begin, feature.items.end(), HasFeature);
  if (head == "or" || head == ":or") return std::any_of(begin, feature.items.end(), HasFeature);
  if (head == "not" || head == ":not") return std::none_of(begin, feature.items.end(), HasFeature);
  return false;
}

class DataReader {
 public:
  /// @param file  null: the text is no whole Lisp file, and its marks mean nothing.
  DataReader(std::string_view text, const std::string& source, const ReaderLimits& limits,
             LispFile* file = nullptr)
      : text_(text), source_(source), limits_(limits), file_(file) {}

  std::vector<Datum> Read();
  std::string FirstWord();

 private:
  bool AtEnd() const { return position_ == text_.size(); }
  char Peek() const { return text_[position_]; }
  bool StartsWith(std::string_view start) const {
    return text_.substr(position_, start.size()) == start;
  }
  char Next();
  void Skip(int count);
  [[noreturn]] void Fail(const std::string& text) const { FailAt(source_, here_, text); }
  [[noreturn]] void FailUnclosed() const;

  void CheckSize() const;
  bool SkipBlanks();
  void SkipLine();
  void SkipBlockComment();

  void ReadOne();
  void ReadHash();
  bool IsPassedOver() const;
  void ReadStrangeHash();
  void ReadCharacter();
  void ReadString();
  void ReadToken();
  bool ReadTokenText(std::string* token);
  void ReadBars(std::string* token);
  char NextInText(const char* what, Place begin);
  void CheckText(const std::string& text, Place place) const;
  void TakeDot(Place place);
  void CheckLength(const std::string& token, Place begin) const;
  Datum TokenDatum(const std::string& token, Place place) const;
  Datum RatioDatum(std::string_view token, Place place) const;
  std::int64_t ParseInteger(std::string_view token, Place place) const;
  double ParseReal(std::string_view token, Place place) const;

  void OpenList();
  void OpenQuote(std::string_view name, int length);
  void Push(Open open);
  void Close();
  void Put(Datum datum, Place place);
  bool TakeMark(const Datum& datum);
  void PutInto(Open* open, Datum datum) const;
  void Count();

  std::string_view text_;
  const std::string& source_;
  const ReaderLimits& limits_;
  LispFile* const file_;
  std::size_t position_{0};
  Place here_{1, 1};  // of position_
  std::size_t num_data_{0};
  std::optional<Place> definition_inside_;  // "(def" that begins a line while lists are open
  std::vector<Open> open_;
  std::vector<Datum> data_;
};

std::vector<Datum> DataReader::Read() {
  CheckSize();
  while (SkipBlanks()) ReadOne();
  if (!open_.empty()) FailUnclosed();
  return std::move(data_);
}

std::string DataReader::FirstWord() {
  CheckSize();
  std::string word;
  if (!SkipBlanks() || Next() != '(' || !SkipBlanks()) return word;
  ReadTokenText(&word);
  CheckText(word, here_);
  return word;
}

void DataReader::CheckSize() const {
  if (text_.size() <= limits_.max_bytes) return;
  Fail(fmt::format("the text has {} bytes, at most {} are read; split it", text_.size(),
                   limits_.max_bytes));
}

char DataReader::Next() {
  const char c = text_[position_++];
  if (c == '\n') {
    here_ = {here_.line + 1, 1};
  } else if ((static_cast<unsigned char>(c) & 0xC0u) != 0x80u) {  // no later byte of UTF-8
    ++here_.column;
  }
  return c;
}

void DataReader::Skip(int count) {
  for (int i = 0; i < count; ++i) Next();
}

void DataReader::FailUnclosed() const {
  const Open& open = open_.back();
  FailAt(source_, open.list.place,
         !open.IsList()
             ? "the text ends after this quote or mark; write what belongs to it, or take "
               "it away"
             : fmt::format("the text ends in line {} before the list that opens here is "
                           "closed; add the missing ')'{}",
                           here_.line,
                           definition_inside_
                               ? fmt::format(", before line {}, where a definition begins "
                                             "within another",
                                             definition_inside_->line)
                               : ""));
}

// ---------------------------------------------------------------------------- blanks and comments

/// False at the end of the text.
bool DataReader::SkipBlanks() {
  while (!AtEnd()) {
    if (IsBlank(Peek())) {
      Next();
    } else if (StartsWith(kByteOrderMark)) {  // some editors write one, joined files have several
      Skip(3);
    } else if (const std::size_t length = WideBlankLength(text_.substr(position_)); length > 0) {
      Skip(static_cast<int>(length));
    } else if (Peek() == ';') {
      SkipLine();
    } else if (StartsWith("#|")) {
      SkipBlockComment();
    } else {
      return true;
    }
  }
  return false;
}

void DataReader::SkipLine() {
  while (!AtEnd() && Next() != '\n') {
  }
}

void DataReader::SkipBlockComment() {
  const Place begin = here_;
  std::size_t depth = 0;  // they nest
  do {
    if (AtEnd()) {
      FailAt(source_, begin, "the comment #| that opens here has no end; add the missing |#");
    }
    const bool opens = StartsWith("#|");
    const bool closes = StartsWith("|#");
    depth = opens ? depth + 1 : closes ? depth - 1 : depth;
    Skip(opens || closes ? 2 : 1);
  } while (depth > 0);
}

// --------------------------------------------------------------------------------- lists and
// quotes

void DataReader::ReadOne() {
  switch (Peek()) {
    case '(':
      return OpenList();
    case ')':
      return Close();
    case '\'':
      return OpenQuote("quote", 1);
    case '`':
      return OpenQuote("backquote", 1);
    case ',':
      if (!StartsWith(",@")) return OpenQuote("unquote", 1);
      if (IsPassedOver()) return OpenQuote("unquote", 2);
      Fail("',@' is not supported; build the list with 'append' instead");
    case '"':
      return ReadString();
    case '#':
      return ReadHash();
    default:
      return ReadToken();
  }
}

void DataReader::ReadHash() {
  if (StartsWith("#'")) return OpenQuote("function", 2);
  if (StartsWith("#:")) {
    Skip(2);
    if (AtEnd() || EndsToken(Peek()))
      Fail("a name was wanted after '#:'; write it, or take '#:' away");
    return ReadToken();
  }
  if (file_ != nullptr && (StartsWith("#+") || StartsWith("#-"))) {
    Push({{}, StartsWith("#+") ? Open::Wants::kRequired : Open::Wants::kForbidden});
    return Skip(2);
  }
  if (IsPassedOver()) return ReadStrangeHash();
  if (StartsWith("#.")) {
    Fail("'#.' runs code while a file is read, which no file may; write the value itself");
  }
  Fail(
      "'#' starts nothing that is known here; wanted #'function, #| comment |#, or a name that "
      "does not begin with '#' (|#name| if it must)");
}

/// Left out by a mark, or within a list that is none of the file's definitions, nor within one.
bool DataReader::IsPassedOver() const {
  if (file_ == nullptr || open_.empty()) return false;
  bool is_meant = false;
  for (const Open& open : open_) {
    if (open.wants == Open::Wants::kSkipped) return true;
    const std::string_view head = WithoutPackage(open.list.Head());
    const auto& known = file_->definitions;
    is_meant = is_meant || std::find(known.begin(), known.end(), head) != known.end();
  }
  return !is_meant;
}

/// Vectors, numbers, structures and others: what follows the sign and its letter is read as it is.
void DataReader::ReadStrangeHash() {
  if (StartsWith("#\\")) return ReadCharacter();
  const bool is_evaluated = StartsWith("#.");
  Skip(is_evaluated ? 2 : 1);
  if (is_evaluated || AtEnd() || EndsToken(Peek())) return;
  ReadToken();
}

/// #\a, #\( and #\Space.
void DataReader::ReadCharacter() {
  const Place begin = here_;
  Count();
  Skip(2);
  std::string name = "#\\";
  do {
    name += NextInText("character", begin);
    CheckLength(name, begin);
  } while (!AtEnd() && !EndsToken(Peek()));
  CheckText(name, begin);
  Put(MakeSymbol(name), begin);
}

void DataReader::Count() {
  if (++num_data_ <= limits_.max_data) return;
  Fail(fmt::format("more than {} symbols, numbers, strings and lists; split the file",
                   limits_.max_data));
}

void DataReader::Push(Open open) {
  Count();
  if (open_.size() >= static_cast<std::size_t>(limits_.max_depth)) {
    Fail(
        fmt::format("{} lists are open here, the outermost since line {}, column {}; close them "
                    "with ')' or nest less",
                    open_.size(), open_.front().list.place.line, open_.front().list.place.column));
  }
  open.list.place = here_;
  open_.push_back(std::move(open));
}

void DataReader::OpenList() {
  if (!definition_inside_ && !open_.empty() && here_.column == 1 && StartsWith("(def"))
    definition_inside_ = here_;
  Push({});
  Next();
}

void DataReader::OpenQuote(std::string_view name, int length) {
  Datum symbol = MakeSymbol(name);
  symbol.place = here_;
  Push({MakeList({std::move(symbol)}), Open::Wants::kQuoted});
  Skip(length);
}

void DataReader::Close() {
  if (open_.empty()) Fail("')' closes nothing; take it away, or look for a ')' too many above");
  Open open = std::move(open_.back());
  if (!open.IsList()) {
    Fail(
        "')' follows a quote or a mark; write what belongs to the quote or the mark, or take it "
        "away");
  }
  if (open.wants == Open::Wants::kTail) {
    Fail("')' follows a dot; write the rest of the list after the dot, as in (?first . ?rest)");
  }
  open_.pop_back();
  Next();
  const Place place = open.list.place;
  Put(std::move(open.list), place);
}

void DataReader::Put(Datum datum, Place place) {
  datum.place = place;
  while (!open_.empty() && !open_.back().IsList()) {
    if (TakeMark(datum)) return;
    Datum quoted = std::move(open_.back().list);
    open_.pop_back();
    quoted.items.push_back(std::move(datum));
    datum = std::move(quoted);
  }
  if (open_.empty()) {
    data_.push_back(std::move(datum));
  } else {
    PutInto(&open_.back(), std::move(datum));
  }
}

/// Whether the datum belongs to a mark, and so to nothing else.
bool DataReader::TakeMark(const Datum& datum) {
  const Open::Wants wants = open_.back().wants;
  if (wants == Open::Wants::kQuoted) return false;
  const Place place = open_.back().list.place;
  open_.pop_back();
  if (wants == Open::Wants::kSkipped) return true;
  const bool is_read = HasFeature(datum) == (wants == Open::Wants::kRequired);
  (is_read ? file_->kept : file_->skipped).push_back(place);
  if (is_read) return true;
  Push({{}, Open::Wants::kSkipped});
  open_.back().list.place = place;
  return true;
}

void DataReader::PutInto(Open* open, Datum datum) const {
  Datum& list = open->list;
  if (open->wants == Open::Wants::kEnd) {
    FailAt(source_, datum.place,
           "a second datum follows a dot; after a dot comes one datum, then ')'");
  }
  if (open->wants == Open::Wants::kItems) {
    list.items.push_back(std::move(datum));
    return;
  }
  open->wants = Open::Wants::kEnd;
  if (datum.IsNil()) return;  // (a . nil) is (a)
  if (!datum.IsList()) {
    list.tail.push_back(std::move(datum));
    return;
  }
  // (a . (b . ?c)) is (a b . ?c).
  std::move(datum.items.begin(), datum.items.end(), std::back_inserter(list.items));
  list.tail = std::move(datum.tail);
}

void DataReader::TakeDot(Place place) {
  const bool fits = !open_.empty() && open_.back().wants == Open::Wants::kItems &&
                    !open_.back().list.items.empty();
  if (!fits) {
    FailAt(source_, place,
           "a dot stands here; it belongs before the last datum of a list, as in (?first . ?rest)");
  }
  open_.back().wants = Open::Wants::kTail;
}

// ------------------------------------------------------------------------ symbols, numbers,
// strings

char DataReader::NextInText(const char* what, Place begin) {
  if (AtEnd()) {
    FailAt(source_, begin, fmt::format("the {} that begins here has no end; close it", what));
  }
  if (IsControl(Peek())) {
    Fail(fmt::format("the control character {:#04x} stands here; take it away",
                     static_cast<unsigned>(static_cast<unsigned char>(Peek()))));
  }
  return Next();
}

void DataReader::CheckText(const std::string& text, Place place) const {
  if (ValidUtf8Length(text) == text.size()) return;
  FailAt(source_, place, "a letter here is not written in UTF-8; save the file as UTF-8");
}

void DataReader::ReadString() {
  const Place begin = here_;
  Count();
  Next();
  std::string text;
  for (char c = NextInText("string", begin); c != '"'; c = NextInText("string", begin)) {
    text += c == '\\' ? NextInText("string", begin) : c;
    if (text.size() > limits_.max_string) {
      FailAt(source_, begin,
             fmt::format("the string that begins here is longer than {} bytes; is its closing "
                         "quote missing?",
                         limits_.max_string));
    }
  }
  CheckText(text, begin);
  Put(MakeString(text), begin);
}

void DataReader::ReadToken() {
  const Place begin = here_;
  Count();
  std::string token;
  const bool is_plain = ReadTokenText(&token);
  CheckText(token, begin);
  if (!is_plain) return Put(MakeSymbol(token), begin);
  if (token == ".") return TakeDot(begin);
  Put(TokenDatum(token, begin), begin);
}

/// False if bars or backslashes make the token a symbol, whatever it looks like.
bool DataReader::ReadTokenText(std::string* token) {
  const Place begin = here_;
  bool is_plain = true;
  while (!AtEnd() && !EndsToken(Peek()) && WideBlankLength(text_.substr(position_)) == 0) {
    const char c = NextInText("symbol", begin);
    if (c == '|') {
      ReadBars(token);
      is_plain = false;
    } else if (c == '\\') {
      *token += ToLowerAscii(NextInText("symbol", begin));
      is_plain = false;
    } else {
      *token += ToLowerAscii(c);
    }
    CheckLength(*token, begin);
  }
  return is_plain;
}

/// After the first bar, up to the second.
void DataReader::ReadBars(std::string* token) {
  const Place begin = here_;
  for (char c = NextInText("|symbol|", begin); c != '|'; c = NextInText("|symbol|", begin)) {
    *token += ToLowerAscii(c == '\\' ? NextInText("|symbol|", begin) : c);
    CheckLength(*token, begin);
  }
}

void DataReader::CheckLength(const std::string& token, Place begin) const {
  if (token.size() <= limits_.max_symbol) return;
  FailAt(source_, begin,
         fmt::format("the symbol '{}' is longer than {} bytes; shorten it", Cut(token, 40),
                     limits_.max_symbol));
}

Datum DataReader::TokenDatum(const std::string& token, Place place) const {
  switch (KindOfToken(token)) {
    case TokenKind::kSymbol:
      return MakeSymbol(token);
    case TokenKind::kVariable:
      return MakeVariable(token);
    case TokenKind::kInteger:
      return MakeInteger(ParseInteger(token, place));
    case TokenKind::kReal:
      return MakeReal(ParseReal(token, place));
    case TokenKind::kRatio:
      return RatioDatum(token, place);
    case TokenKind::kDots:
      break;
  }
  FailAt(source_, place,
         fmt::format("'{}' is no name; write one dot before the last datum of a list, or a name",
                     Cut(token, 40)));
}

std::int64_t DataReader::ParseInteger(std::string_view token, Place place) const {
  const std::string_view digits = token.substr(token[0] == '+' ? 1 : 0);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc()) return value;
  FailAt(source_, place,
         fmt::format("the integer {} is beyond 64 bits; write it as a real number, {}.0",
                     Cut(token, 40), Cut(token, 40)));
}

double DataReader::ParseReal(std::string_view token, Place place) const {
  std::string text(token.substr(token[0] == '+' ? 1 : 0));
  // Lisp's letters for its kinds of reals all mean "times ten to the power of".
  std::replace_if(
      text.begin(), text.end(), [](char c) { return std::isalpha(static_cast<unsigned char>(c)); },
      'e');
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc()) return value;
  FailAt(source_, place,
         fmt::format("the number {} is beyond what a real number holds (about 1e-308 to 1e308); "
                     "choose another unit",
                     Cut(token, 40)));
}

/// 1/2 is 0.5, 4/2 is the integer 2.
Datum DataReader::RatioDatum(std::string_view token, Place place) const {
  const std::size_t slash = token.find('/');
  const std::int64_t upper = ParseInteger(token.substr(0, slash), place);
  const std::int64_t lower = ParseInteger(token.substr(slash + 1), place);
  if (lower == 0) {
    FailAt(source_, place, fmt::format("{} divides by zero; correct it", Cut(token, 40)));
  }
  if (upper % lower == 0) return MakeInteger(upper / lower);
  return MakeReal(static_cast<double>(upper) / static_cast<double>(lower));
}

}  // namespace

std::vector<Datum> ReadData(std::string_view text, const std::string& source,
                            const ReaderLimits& limits) {
  return DataReader(text, source, limits).Read();
}

std::vector<Datum> ReadLispFile(std::string_view text, const std::string& source, LispFile* file) {
  const ReaderLimits limits;
  return DataReader(text, source, limits, file).Read();
}

std::string_view WithoutPackage(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  const bool has_package =
      colon != std::string_view::npos && name.front() != ':' && colon + 1 < name.size();
  return has_package ? name.substr(colon + 1) : name;
}

std::string FirstWord(std::string_view text, const std::string& source) {
  const ReaderLimits limits;
  return DataReader(text, source, limits).FirstWord();
}

std::string Excerpt(const Datum& datum) {
  std::string text = Cut(ToString(datum, kMaxExcerpt + 1), kMaxExcerpt);
  std::replace_if(text.begin(), text.end(), IsBlank, ' ');
  return text;
}

std::string Located(const std::string& source, Place place, const std::string& text) {
  return fmt::format("{}:{}:{}: {}", source, place.line, place.column, text);
}

void FailAt(const std::string& source, Place place, const std::string& text) {
  throw base::ConfigError(Located(source, place, text));
}

}  // namespace hires::planning
