#include "knowledge/ontology/ontology_rdf.h"

#include <fmt/format.h>
#include <raptor2/raptor2.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <mutex>
#include <optional>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "knowledge/ontology/ontology_words.h"

namespace hires::knowledge {
namespace {

// Raptor's memory and time grow with these, some of them with the square.
constexpr int kMaxDepth = 100;
constexpr int kMaxBases = 10;
constexpr std::size_t kMaxIri = 200;
constexpr std::size_t kMaxString = 64u << 10;
constexpr std::size_t kMaxStatements = 200'000;
constexpr const char* kBase = "urn:x-hires:base";
constexpr const char* kNul = "there is a NUL byte, wanted text; is this an ontology in Turtle?";

/// How the text is written.
enum class Notation { kTurtle, kRdfXml };

[[noreturn]] void FailInText(const std::string& source, int line, const std::string& what) {
  throw base::ConfigError(fmt::format("{}: {}; line {}", source, what, line));
}

/// Walks over a text in Turtle before raptor sees it: raptor has no limit of depth, takes a NUL for
/// the end of a name, and does not say in which line a prefix is declared.
class TurtleScan {
 public:
  TurtleScan(std::string_view text, const std::string& source) : text_(text), source_(source) {
    while (at_ < text_.size()) Step();
  }

  /// Line of the declaration of a prefix, counted from 0; the last one's where there are fewer.
  int PrefixLine(std::size_t index) const {
    if (prefix_lines_.empty()) return 1;
    return prefix_lines_[std::min(index, prefix_lines_.size() - 1)];
  }

 private:
  void Step() {
    switch (text_[at_]) {
      case '#':
        return SkipComment();
      case '<':
        return SkipIri();
      case '"':
      case '\'':
        return SkipString();
      case '[':
      case '(':
        Open();
        break;
      case ']':
      case ')':
        --depth_;
        break;
      default:
        if (Declares("prefix")) prefix_lines_.push_back(line_);
        if (Declares("base")) CountBase();
    }
    Advance();
  }

  void Open() {
    if (++depth_ <= kMaxDepth) return;
    FailInText(source_, line_,
               fmt::format("brackets are nested more than {} deep; give the inner nodes names",
                           kMaxDepth));
  }

  void Advance() {
    const char c = text_[at_++];
    if (c == '\0') FailInText(source_, line_, kNul);
    if (c == '\n') ++line_;
  }

  void Advance(std::size_t count) {
    while (count-- > 0 && at_ < text_.size()) Advance();
  }

  bool Starts(std::string_view with) const { return knowledge::Starts(text_.substr(at_), with); }

  /// `@prefix a: <b> .` or, as in SPARQL, `PREFIX a: <b>`; `base` likewise.
  bool Declares(std::string_view word) const {
    if (text_[at_] == '@') return text_.substr(at_ + 1, word.size()) == word;
    const bool starts_word = at_ == 0 || std::isspace(static_cast<unsigned char>(text_[at_ - 1]));
    const std::size_t end = at_ + word.size();
    return starts_word && end < text_.size() &&
           std::isspace(static_cast<unsigned char>(text_[end])) &&
           base::ToLower(text_.substr(at_, word.size())) == word;
  }

  void CountBase() {
    if (++num_bases_ > kMaxBases) {
      FailInText(source_, line_, fmt::format("more than {} bases; write whole IRIs", kMaxBases));
    }
  }

  void SkipComment() {
    while (at_ < text_.size() && text_[at_] != '\n') Advance();
  }

  /// An IRI holds no blanks; raptor complains where one does.
  void SkipIri() {
    const std::size_t end = std::min(text_.find_first_of("> \t\r\n", at_), text_.size());
    CheckLength("an IRI", end - at_, kMaxIri);
    Advance(end + 1 - at_);
  }

  void SkipString() {
    const std::string quote(1, text_[at_]);
    const std::string end = Starts(quote + quote + quote) ? quote + quote + quote : quote;
    const std::size_t start = at_;
    Advance(end.size());
    while (at_ < text_.size() && !Starts(end)) Advance(text_[at_] == '\\' ? 2 : 1);
    CheckLength("a text", at_ - start, kMaxString);
    Advance(end.size());
  }

  void CheckLength(const char* what, std::size_t length, std::size_t at_most) const {
    if (length <= at_most) return;
    FailInText(
        source_, line_,
        fmt::format("{} is {} bytes long, at most {} are read; shorten it", what, length, at_most));
  }

  std::string_view text_;
  const std::string& source_;
  std::size_t at_{0};
  int depth_{0};
  int num_bases_{0};
  int line_{1};
  std::vector<int> prefix_lines_;
};

/// Walks over a text in XML before raptor sees it, which has no limit of depth, of attributes, or
/// of what entities stand for.
class XmlScan {
 public:
  XmlScan(std::string_view text, const std::string& source) : text_(text), source_(source) {
    if (text_.find('\0') != std::string_view::npos) FailInText(source_, 1, kNul);
    for (at_ = text_.find('<'); at_ < text_.size(); at_ = text_.find('<', at_)) Step();
    const auto references = static_cast<std::size_t>(std::count(text_.begin(), text_.end(), '&'));
    if (references * longest_entity_ <= kMaxExpanded) return;
    Fail(0,
         fmt::format("what its entities stand for may be {} bytes, at most {} are read; write it "
                     "without them, as `xmllint --noent` does",
                     references * longest_entity_, kMaxExpanded));
  }

  const std::string& root() const { return root_; }  ///< "rdf:RDF"

 private:
  static constexpr std::size_t kMaxAttributes = 500;
  static constexpr std::size_t kMaxExpanded = 16u << 20;

  void Step() {
    if (Skips("<!--", "-->") || Skips("<![CDATA[", "]]>") || Skips("<?", "?>")) return;
    if (Starts("<!DOCTYPE")) return ReadDocumentType();
    ReadTag();
  }

  void ReadTag() {
    const std::size_t begin = at_;
    const bool closes = Starts("</");
    std::size_t num_attributes = 0;
    for (++at_; at_ < text_.size() && text_[at_] != '>'; ++at_) {
      if (text_[at_] == '=' && ++num_attributes > kMaxAttributes)
        Fail(begin, fmt::format("an element has more than {} attributes", kMaxAttributes));
      SkipQuoted();
    }
    if (closes) {
      depth_ = std::max(depth_ - 1, 0);
    } else if (text_[at_ - 1] != '/' && ++depth_ > kMaxDepth) {
      Fail(begin, fmt::format("elements are nested more than {} deep; give the inner ones names",
                              kMaxDepth));
    }
    if (root_.empty() && !closes)
      root_ = text_.substr(begin + 1, text_.find_first_of(" \t\r\n/>", begin) - begin - 1);
  }

  /// With the entities that it declares between brackets.
  void ReadDocumentType() {
    bool is_within = false;
    for (at_ += 9; at_ < text_.size(); ++at_) {
      if (text_[at_] == '[') is_within = true;
      if (text_[at_] == ']') is_within = false;
      if (text_[at_] == '>' && !is_within) return;
      if (Skips("<!--", "-->") || Skips("<?", "?>")) {
        --at_;
      } else if (Starts("<!ENTITY")) {
        ReadEntity();
      } else {
        SkipQuoted();
      }
    }
  }

  void ReadEntity() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '>') {
      const std::size_t quote = at_;
      SkipQuoted();
      const std::string_view value = text_.substr(quote, at_ - quote);
      longest_entity_ = std::max(longest_entity_, value.size());
      // References to characters, and to those that XML itself has, stand for one letter.
      for (std::size_t i = value.find('&'); i < value.size(); i = value.find('&', i + 1)) {
        const std::string_view rest = value.substr(i + 1);
        const auto is = [&](std::string_view name) { return knowledge::Starts(rest, name); };
        if (is("#") || is("amp;") || is("lt;") || is("gt;") || is("quot;") || is("apos;")) continue;
        Fail(begin, "an entity stands for others, which is not read; write their text");
      }
      ++at_;
    }
  }

  /// To the end of an attribute's value, or whatever stands in quotes.
  void SkipQuoted() {
    const char quote = text_[at_];
    if (quote != '"' && quote != '\'') return;
    at_ = std::min(text_.find(quote, at_ + 1), text_.size() - 1);
  }

  bool Starts(std::string_view with) const { return knowledge::Starts(text_.substr(at_), with); }

  bool Skips(std::string_view begin, std::string_view end) {
    if (!Starts(begin)) return false;
    const std::size_t found = text_.find(end, at_);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
    return true;
  }

  [[noreturn]] void Fail(std::size_t at, const std::string& what) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at), '\n');
    FailInText(source_, static_cast<int>(line), what);
  }

  std::string_view text_;
  const std::string& source_;
  std::size_t at_{0};
  int depth_{0};
  std::size_t longest_entity_{0};
  std::string root_;
};

[[noreturn]] void FailOnNotation(const std::string& source, const std::string& what) {
  FailInText(
      source, 1,
      fmt::format("is {}, wanted Turtle or RDF/XML; convert it, with Protege (save as Turtle) "
                  "or `robot convert --input FILE --output FILE.ttl`",
                  what));
}

/// An IRI in Turtle begins as a tag in XML does, but has no blanks.
bool IsXml(std::string_view text) {
  if (Starts(text, "<?xml") || Starts(text, "<!")) return true;
  if (!Starts(text, "<")) return false;
  const std::string_view tag = text.substr(0, text.find('>'));
  return tag.find_first_of(" \t\r\n") != std::string_view::npos || tag == "<rdf:RDF";
}

/// @throws ConfigError for the other notations that ontologies are published in.
Notation NotationOf(std::string_view text, const std::string& source) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return Notation::kTurtle;
  text.remove_prefix(begin);
  if (Starts(text, "Prefix(") || Starts(text, "Ontology("))
    FailOnNotation(source, "OWL in functional syntax");
  if (Starts(text, "Prefix:") || Starts(text, "Ontology:"))
    FailOnNotation(source, "OWL in Manchester syntax");
  if (Starts(text, "{")) FailOnNotation(source, "JSON");
  if (!IsXml(text)) return Notation::kTurtle;
  const std::string root = XmlScan(text, source).root();
  const std::string name = root.substr(root.find(':') + 1);  // find() + 1 is 0 without a prefix
  if (name == "Ontology") FailOnNotation(source, "OWL/XML");
  if (name != "RDF") FailOnNotation(source, fmt::format("XML whose root is <{}>", root));
  return Notation::kRdfXml;
}

struct RaptorDeleter {
  void operator()(raptor_world* world) const { raptor_free_world(world); }
  void operator()(raptor_parser* parser) const { raptor_free_parser(parser); }
  void operator()(raptor_uri* uri) const { raptor_free_uri(uri); }
};
template <typename T>
using RaptorPointer = std::unique_ptr<T, RaptorDeleter>;

std::string Text(const unsigned char* text) {
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

std::string Text(raptor_uri* uri) { return Text(raptor_uri_as_string(uri)); }

RdfNode ToNode(const raptor_term& term) {
  switch (term.type) {
    case RAPTOR_TERM_TYPE_URI:
      return {RdfNode::Kind::kIri, Text(term.value.uri)};
    case RAPTOR_TERM_TYPE_BLANK:
      return {RdfNode::Kind::kBlank, Text(term.value.blank.string)};
    default:
      return {RdfNode::Kind::kLiteral, Text(term.value.literal.string)};
  }
}

/// What raptor's callbacks write to. They are called from C, so they must not throw: the first
/// error is kept and told afterwards.
struct Parse {
  RdfDocument* document;
  Notation notation;
  const TurtleScan* scan;       // null for XML
  std::size_t num_prefixes{0};  // seen up to now
  raptor_parser* parser{nullptr};
  std::string error{};
  int error_line{0};
  int skipped_lines{0};  // before the XML begins

  int Line() const {
    return skipped_lines + raptor_locator_line(raptor_parser_get_locator(parser));
  }
  void Stop(const std::string& what, int line) {
    if (!error.empty()) return;
    error = what;
    error_line = line;
    raptor_parser_parse_abort(parser);
  }
};

void OnStatement(void* user_data, raptor_statement* statement) {
  auto& parse = *static_cast<Parse*>(user_data);
  std::vector<RdfStatement>& statements = parse.document->statements;
  if (statements.size() >= kMaxStatements) {
    return parse.Stop(fmt::format("more than {} statements", kMaxStatements), parse.Line());
  }
  statements.push_back({ToNode(*statement->subject), ToNode(*statement->predicate).value,
                        ToNode(*statement->object), parse.Line()});
}

void OnNamespace(void* user_data, raptor_namespace* name_space) {
  auto& parse = *static_cast<Parse*>(user_data);
  const std::string prefix = Text(raptor_namespace_get_prefix(name_space));
  const std::string iri = Text(raptor_namespace_get_uri(name_space));
  const auto [known, is_new] = parse.document->prefixes.emplace(prefix, iri);
  if (parse.scan == nullptr) return;  // in XML a prefix holds for an element alone
  const int line = parse.scan->PrefixLine(parse.num_prefixes++);
  if (is_new || known->second == iri) return;
  parse.Stop(fmt::format("prefix '{}:' is <{}> and was <{}> before; choose another prefix", prefix,
                         iri, known->second),
             line);
}

/// 'The namespace prefix in "rdfs:label" was not declared.' of raptor, "Namespace prefix rdfs on
/// label is not defined" of the XML parser; or nothing.
std::string UndeclaredPrefix(const std::string& message) {
  for (const std::string before : {"The namespace prefix in \"", "Namespace prefix "}) {
    const std::size_t begin = message.find(before);
    if (begin == std::string::npos) continue;
    const std::string rest = message.substr(begin + before.size());
    return rest.substr(0, rest.find_first_of(": \""));
  }
  return "";
}

std::string InOurWords(const std::string& message, Notation notation) {
  const std::string prefix = UndeclaredPrefix(message);
  const bool is_turtle = notation == Notation::kTurtle;
  if (prefix.empty())
    return fmt::format("this is no {}: {}", is_turtle ? "Turtle" : "RDF/XML", message);
  const auto known = KnownPrefixes().find(prefix);
  const std::string iri = known == KnownPrefixes().end() ? "..." : known->second;
  return fmt::format("prefix '{}:' is not declared; add {}", prefix,
                     is_turtle ? fmt::format("@prefix {}: <{}> .", prefix, iri)
                               : fmt::format("xmlns:{}=\"{}\" to the root", prefix, iri));
}

void OnLog(void* user_data, raptor_log_message* message) {
  if (message->level < RAPTOR_LOG_LEVEL_ERROR) return;
  auto& parse = *static_cast<Parse*>(user_data);
  const int line = message->locator == nullptr
                       ? -1
                       : parse.skipped_lines + raptor_locator_line(message->locator);
  // Some messages come without a line; the next one, about the same, has it. Parsing is not
  // aborted: it ends by itself.
  if (parse.error_line < 1) parse.error_line = line;
  if (parse.error.empty()) parse.error = InOurWords(message->text, parse.notation);
}

/// The curl library and its process-wide set-up are left alone: nothing is fetched.
RaptorPointer<raptor_world> NewWorld() {
  RaptorPointer<raptor_world> world(raptor_new_world());
  if (!world) throw base::ConfigError("raptor cannot start; is there memory left?");
  raptor_world_set_flag(world.get(), RAPTOR_WORLD_FLAG_WWW_SKIP_INIT_FINISH, 1);
  if (raptor_world_open(world.get()) != 0) throw base::ConfigError("raptor cannot start");
  return world;
}

void RunRaptor(std::string_view text, Parse* parse) {
  static std::mutex mutex;  // raptor's start touches process-wide state of libxml2
  const std::lock_guard<std::mutex> lock(mutex);
  const RaptorPointer<raptor_world> world = NewWorld();
  raptor_world_set_log_handler(world.get(), parse, OnLog);
  const bool is_turtle = parse->notation == Notation::kTurtle;
  const RaptorPointer<raptor_parser> parser(
      raptor_new_parser(world.get(), is_turtle ? "turtle" : "rdfxml"));
  const RaptorPointer<raptor_uri> base(
      raptor_new_uri(world.get(), reinterpret_cast<const unsigned char*>(kBase)));
  if (!parser || !base) throw base::ConfigError("raptor has no parser of Turtle or RDF/XML");
  parse->parser = parser.get();
  raptor_parser_set_option(parser.get(), RAPTOR_OPTION_NO_NET, nullptr, 1);
  raptor_parser_set_option(parser.get(), RAPTOR_OPTION_NO_FILE, nullptr, 1);
  raptor_parser_set_option(parser.get(), RAPTOR_OPTION_LOAD_EXTERNAL_ENTITIES, nullptr, 0);
  raptor_parser_set_option(parser.get(), RAPTOR_OPTION_CHECK_RDF_ID, nullptr, 0);
  raptor_parser_set_statement_handler(parser.get(), parse, OnStatement);
  raptor_parser_set_namespace_handler(parser.get(), parse, OnNamespace);
  const bool failed =
      raptor_parser_parse_start(parser.get(), base.get()) != 0 ||
      raptor_parser_parse_chunk(parser.get(), reinterpret_cast<const unsigned char*>(text.data()),
                                text.size(), 1) != 0;
  if (failed) parse->Stop(is_turtle ? "this is no Turtle" : "this is no RDF/XML", parse->Line());
  if (parse->error_line < 1) parse->error_line = std::max(parse->Line(), 1);
}

}  // namespace

RdfDocument ReadRdf(std::string_view text, const std::string& source) {
  if (text.size() > kMaxRdfBytes) {
    throw base::ConfigError(fmt::format("{}: is an ontology of {} bytes, at most {} are read",
                                        source, text.size(), kMaxRdfBytes));
  }
  base::RefuseUtf16(text, source);
  RdfDocument document;
  document.source = source;
  Parse parse{&document, NotationOf(text, source), nullptr};
  std::optional<TurtleScan> scan;
  if (parse.notation == Notation::kTurtle) {
    parse.scan = &scan.emplace(text, source);
  } else {  // nothing may stand before an XML declaration
    const std::string_view blanks = text.substr(0, text.find('<'));
    parse.skipped_lines = static_cast<int>(std::count(blanks.begin(), blanks.end(), '\n'));
    text.remove_prefix(blanks.size());
  }
  RunRaptor(text, &parse);
  if (!parse.error.empty()) FailInText(source, parse.error_line, parse.error);
  return document;
}

}  // namespace hires::knowledge
