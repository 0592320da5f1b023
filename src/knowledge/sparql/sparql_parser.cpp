#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "knowledge/sparql/sparql_lexer.h"
#include "knowledge/sparql/sparql_names.h"
#include "knowledge/sparql/sparql_query.h"

namespace hires::knowledge::sparql {
namespace {

constexpr std::size_t kMaxText = 64u << 10;
constexpr int kMaxNesting = 100;
constexpr int kMaxPatterns = 1000;
constexpr std::size_t kMaxVariables = 64;
constexpr const char* kUnderstood =
    "understood are prefix, select, distinct, where, union, patterns with '.', ';' and ',', "
    "rdf:type or a, rdfs:subClassOf with + or *, relations, literals";

std::string_view WordFor(Kind kind) {
  if (kind == Kind::kInstance) return "instances";
  return kind == Kind::kConcept ? "concepts" : "values";
}

/// What a literal for the relation has to be.
enum class LiteralKind { kText, kTruth, kNumber };

LiteralKind KindOfLiteral(const Filler& literal) {
  if (std::holds_alternative<std::string>(literal)) return LiteralKind::kText;
  return std::holds_alternative<bool>(literal) ? LiteralKind::kTruth : LiteralKind::kNumber;
}

LiteralKind KindOfRange(std::string_view range) {
  if (range == "xsd:string") return LiteralKind::kText;
  return range == "xsd:boolean" ? LiteralKind::kTruth : LiteralKind::kNumber;
}

bool IsValue(const Ontology::Relation& relation) {
  return relation.range.compare(0, 4, "xsd:") == 0;
}

class Parser {
 public:
  Parser(std::string_view text, const Ontology& ontology)
      : lexer_(text), names_(ontology), token_(lexer_.Next()) {}
  Query Read();

 private:
  /// A verb with what it says about the terms around it.
  struct Verb {
    Pattern::Verb verb{Pattern::Verb::kType};
    const Ontology::Relation* relation{nullptr};
  };

  [[noreturn]] void Fail(const std::string& wanted) const;
  Token Take();
  bool TakeMark(std::string_view mark);
  bool TakeWord(std::string_view word);
  void RequireMark(std::string_view mark, const std::string& wanted);

  void ReadPrefixes();
  void ReadSelected();
  void CheckSelected();
  Group ReadGroup();
  Element ReadUnion();
  void ReadTriples(Group* group);
  void ReadObjects(const Token& subject, const Verb& verb, Group* group);
  Verb ReadVerb();
  Verb ReadSubclass();
  Term ReadSubject(const Token& token, const Verb& verb);
  Term ReadObject(const Verb& verb);
  Term ReadLiteral(const Ontology::Relation& relation);
  Filler ReadText();
  Filler ReadTyped(const Token& text, const Name& type);
  Filler ReadBare(const Token& token);
  Term ReadVariable(const Token& token, Kind kind);
  Term ReadName(const Token& token, Kind kind);
  int Variable(const Token& token, Kind kind);

  Lexer lexer_;
  Names names_;
  Token token_;  // the next one
  Query query_;
  std::vector<Token> selected_;
  int nesting_{0};
  int num_patterns_{0};
};

void Parser::Fail(const std::string& wanted) const {
  FailAt(token_.place,
         fmt::format("came {}, wanted {}; {}", ToString(token_), wanted, kUnderstood));
}

Token Parser::Take() {
  Token taken = std::move(token_);
  token_ = lexer_.Next();
  return taken;
}

bool Parser::TakeMark(std::string_view mark) {
  if (!token_.IsMark(mark)) return false;
  Take();
  return true;
}

bool Parser::TakeWord(std::string_view word) {
  if (!token_.IsWord(word)) return false;
  Take();
  return true;
}

void Parser::RequireMark(std::string_view mark, const std::string& wanted) {
  if (!TakeMark(mark)) Fail(wanted);
}

/// Whether every solution of the group sets the variable.
bool Sets(const Group& group, int variable);
bool Sets(const Element& element, int variable) {
  if (!element.IsUnion()) {
    return element.pattern.subject.variable == variable ||
           element.pattern.object.variable == variable;
  }
  return std::all_of(element.alternatives.begin(), element.alternatives.end(),
                     [&](const Group& group) { return Sets(group, variable); });
}
bool Sets(const Group& group, int variable) {
  return std::any_of(group.elements.begin(), group.elements.end(),
                     [&](const Element& element) { return Sets(element, variable); });
}

Query Parser::Read() {
  ReadPrefixes();
  ReadSelected();
  TakeWord("where");
  if (!token_.IsMark("{")) Fail("'{' with the patterns");
  query_.where = ReadGroup();
  if (token_.kind != Token::Kind::kEnd) Fail("the end of the query");
  CheckSelected();
  return std::move(query_);
}

void Parser::ReadPrefixes() {
  while (TakeWord("prefix")) {
    const bool is_prefix = token_.kind == Token::Kind::kName && token_.text.back() == ':' &&
                           token_.text.find(':') + 1 == token_.text.size();
    if (!is_prefix) Fail("a prefix, as in 'prefix race: <...#>'");
    const Token prefix = Take();
    if (token_.kind != Token::Kind::kIri) Fail("an IRI in < > that the prefix stands for");
    names_.Declare(prefix.text.substr(0, prefix.text.size() - 1), Take().text);
  }
}

void Parser::ReadSelected() {
  if (!TakeWord("select")) Fail("select");
  TakeWord("distinct");
  while (token_.kind == Token::Kind::kVariable) selected_.push_back(Take());
  if (selected_.empty()) Fail("a variable to select, as in 'select ?instance'");
}

void Parser::CheckSelected() {
  for (const Token& token : selected_) {
    const auto& known = query_.variables;
    const auto found = std::find(known.begin(), known.end(), token.text);
    if (found == known.end()) {
      FailAt(token.place, base::UnknownName("selected variable", token.text, known) +
                              "; wanted one that a pattern names");
    }
    query_.selected.push_back(static_cast<int>(found - known.begin()));
  }
  if (!Sets(query_.where, query_.root())) {
    FailAt(selected_.front().place, "came " + ToString(selected_.front()) +
                                        ", which some alternative of a union does not set; wanted "
                                        "a first variable that each of them names");
  }
}

Group Parser::ReadGroup() {
  if (++nesting_ > kMaxNesting) {
    FailAt(token_.place, fmt::format("came more than {} nested groups, wanted fewer", kMaxNesting));
  }
  RequireMark("{", "'{'");
  Group group;
  while (!token_.IsMark("}")) {
    if (token_.IsMark("{")) {
      group.elements.push_back(ReadUnion());
      TakeMark(".");
    } else {
      ReadTriples(&group);
    }
  }
  Take();
  --nesting_;
  return group;
}

Element Parser::ReadUnion() {
  Element element;
  do {
    if (!token_.IsMark("{")) Fail("'{' with the alternative after union");
    element.alternatives.push_back(ReadGroup());
  } while (TakeWord("union"));
  return element;
}

void Parser::ReadTriples(Group* group) {
  const bool is_subject = token_.kind == Token::Kind::kVariable ||
                          token_.kind == Token::Kind::kName || token_.kind == Token::Kind::kIri;
  if (!is_subject) Fail("a variable, a name, '{' or '}'");
  const Token subject = Take();
  ReadObjects(subject, ReadVerb(), group);
  while (TakeMark(";")) {
    if (token_.IsMark(".") || token_.IsMark("}") || token_.IsMark(";")) continue;
    ReadObjects(subject, ReadVerb(), group);
  }
  if (!TakeMark(".") && !token_.IsMark("}") && !token_.IsMark("{")) {
    Fail("'.', ';', ',' or '}' after a pattern");
  }
}

void Parser::ReadObjects(const Token& subject, const Verb& verb, Group* group) {
  do {
    if (++num_patterns_ > kMaxPatterns) {
      FailAt(token_.place, fmt::format("came more than {} patterns, wanted fewer", kMaxPatterns));
    }
    Pattern pattern;
    pattern.subject = ReadSubject(subject, verb);
    pattern.verb = verb.verb;
    if (verb.relation != nullptr) pattern.role = verb.relation->name;
    pattern.object = ReadObject(verb);
    group->elements.push_back({std::move(pattern), {}});
  } while (TakeMark(","));
}

Parser::Verb Parser::ReadVerb() {
  if (TakeWord("a")) return {Pattern::Verb::kType, nullptr};
  if (token_.kind == Token::Kind::kVariable) {
    Fail("a relation by its name: variables in place of relations are not understood");
  }
  if (token_.kind != Token::Kind::kName && token_.kind != Token::Kind::kIri) {
    Fail("a, rdf:type, rdfs:subClassOf or a relation");
  }
  const Name name = names_.Read(Take());
  if (name.Is("rdfs", "subClassOf")) return ReadSubclass();
  Verb verb;
  if (!name.Is("rdf", "type")) {
    verb.verb = Pattern::Verb::kRole;
    verb.relation = &names_.Relation(name);
  }
  for (const char* mark : {"+", "*", "/", "|", "?", "^"}) {
    if (token_.IsMark(mark))
      Fail("an object: of paths, only rdfs:subClassOf+ and * are understood");
  }
  return verb;
}

Parser::Verb Parser::ReadSubclass() {
  if (TakeMark("+")) return {Pattern::Verb::kSubclassPlus, nullptr};
  if (TakeMark("*")) return {Pattern::Verb::kSubclassStar, nullptr};
  return {Pattern::Verb::kSubclassDirect, nullptr};
}

Term Parser::ReadSubject(const Token& token, const Verb& verb) {
  const bool is_instance = verb.verb == Pattern::Verb::kType || verb.verb == Pattern::Verb::kRole;
  const Kind kind = is_instance ? Kind::kInstance : Kind::kConcept;
  return token.kind == Token::Kind::kVariable ? ReadVariable(token, kind) : ReadName(token, kind);
}

Term Parser::ReadObject(const Verb& verb) {
  const bool is_value = verb.relation != nullptr && IsValue(*verb.relation);
  Kind kind = verb.relation == nullptr ? Kind::kConcept : Kind::kInstance;
  if (is_value) kind = Kind::kLiteral;
  if (token_.kind == Token::Kind::kVariable) return ReadVariable(Take(), kind);
  if (is_value) return ReadLiteral(*verb.relation);
  if (token_.kind != Token::Kind::kName && token_.kind != Token::Kind::kIri) {
    Fail(kind == Kind::kConcept ? "a variable or a concept"
                                : "a variable or an instance: " + verb.relation->name +
                                      " links to a " + verb.relation->range);
  }
  return ReadName(Take(), kind);
}

Term Parser::ReadLiteral(const Ontology::Relation& relation) {
  const Token start = token_;
  const std::string wanted =
      fmt::format("a variable or a value: {} is of type {}", relation.name, relation.range);
  const bool is_bare =
      token_.kind == Token::Kind::kNumber || token_.IsWord("true") || token_.IsWord("false");
  if (!is_bare && token_.kind != Token::Kind::kText) Fail(wanted);
  Term term;
  term.kind = Kind::kLiteral;
  Filler literal = is_bare ? ReadBare(Take()) : ReadText();
  if (KindOfLiteral(literal) != KindOfRange(relation.range)) {
    FailAt(start.place, fmt::format("came {} of another type, wanted {}", ToString(start), wanted));
  }
  term.constant = std::move(literal);
  return term;
}

Filler Parser::ReadText() {
  const Token text = Take();
  if (!TakeMark("^^")) return text.text;
  if (token_.kind != Token::Kind::kName && token_.kind != Token::Kind::kIri) {
    Fail("a type after '^^', as in \"0.0\"^^xsd:float");
  }
  return ReadTyped(text, names_.Read(Take()));
}

template <typename Number>
Number ReadNumber(const Token& token, const char* wanted) {
  Number number{};
  std::string_view text = token.text;
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) {
    FailAt(token.place, fmt::format("came {}, wanted {}", ToString(token), wanted));
  }
  return number;
}

double ReadReal(const Token& token) {
  const auto number = ReadNumber<double>(token, "a finite number");
  if (std::isfinite(number)) return number;
  FailAt(token.place, fmt::format("came {}, wanted a finite number", ToString(token)));
}

Filler Parser::ReadTyped(const Token& text, const Name& type) {
  const std::string& name = type.local;
  if (type.space == "xsd") {
    if (name == "string") return text.text;
    if (name == "float" || name == "double" || name == "decimal") return ReadReal(text);
    if (name == "int" || name == "integer" || name == "long") {
      return ReadNumber<std::int64_t>(text, "a whole number of 64 bits");
    }
    if (name == "boolean") {
      if (text.text == "true" || text.text == "1") return true;
      if (text.text == "false" || text.text == "0") return false;
      FailAt(text.place, "came " + ToString(text) + ", wanted true or false");
    }
  }
  FailAt(type.place,
         "came the type " + type.written +
             ", wanted one of xsd:float, xsd:double, xsd:decimal, xsd:int, xsd:integer, "
             "xsd:long, xsd:boolean, xsd:string");
}

Filler Parser::ReadBare(const Token& token) {
  if (token.kind == Token::Kind::kWord) return token.IsWord("true");
  const bool is_whole = token.text.find_first_of(".eE") == std::string::npos;
  if (is_whole) return ReadNumber<std::int64_t>(token, "a whole number of 64 bits");
  return ReadReal(token);
}

Term Parser::ReadVariable(const Token& token, Kind kind) {
  Term term;
  term.kind = kind;
  term.variable = Variable(token, kind);
  return term;
}

Term Parser::ReadName(const Token& token, Kind kind) {
  const Name name = names_.Read(token);
  Term term;
  term.kind = kind;
  if (kind == Kind::kConcept) {
    term.constant = names_.Concept(name);
  } else if (name.local.empty()) {
    FailAt(token.place, "came " + ToString(token) + ", wanted a name after the prefix");
  } else {
    term.constant = Instance{base::ToLower(name.local)};
  }
  return term;
}

int Parser::Variable(const Token& token, Kind kind) {
  auto& known = query_.variables;
  const auto found = std::find(known.begin(), known.end(), token.text);
  const auto index = static_cast<std::size_t>(found - known.begin());
  if (found == known.end()) {
    if (known.size() == kMaxVariables) {
      FailAt(token.place, fmt::format("came more than {} variables, wanted fewer", kMaxVariables));
    }
    known.push_back(token.text);
    query_.kinds.push_back(kind);
  } else if (query_.kinds[index] != kind) {
    FailAt(token.place,
           fmt::format("came {} for {}, it stands for {} elsewhere; wanted another name",
                       ToString(token), WordFor(kind), WordFor(query_.kinds[index])));
  }
  return static_cast<int>(index);
}

}  // namespace

Query ReadQuery(std::string_view text, const Ontology& ontology) {
  if (text.size() > kMaxText) {
    throw base::ConfigError(
        fmt::format("query: came {} bytes, wanted at most {}", text.size(), kMaxText));
  }
  return Parser(text, ontology).Read();
}

}  // namespace hires::knowledge::sparql
