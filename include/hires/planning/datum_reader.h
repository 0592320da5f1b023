#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/datum.h"

namespace hires::planning {

/// What a text may ask of the reader. Beyond it reading ends with an error, early and in bounded
/// memory.
struct ReaderLimits {
  std::size_t max_bytes{64u << 20};  ///< of the text
  int max_depth{1000};               ///< parentheses and quotes open at the same time
  std::size_t max_symbol{1000};      ///< bytes of a symbol, a variable or a number
  std::size_t max_string{1u << 20};  ///< bytes of a string
  std::size_t max_data{1'000'000};   ///< symbols, numbers, strings and lists
};

/// Reads Lisp data as SHOP2 and HDDL files hold them, whatever they may mean: lists, dotted lists,
/// symbols, `#:x` (the symbol x), keywords `:x` (symbols that keep their colon), variables `?x`,
/// integers, reals, ratios (as reals), strings, `'x` `` `x `` `,x` `#'f` as (quote x) (backquote x)
/// (unquote x) (function f), comments `;` and `#| |#`. Letters become lower case, except in
/// strings.
/// @param source  File, for messages.
/// @throws base::ConfigError naming source:line:column, what came, what was wanted, what to do.
std::vector<Datum> ReadData(std::string_view text, const std::string& source,
                            const ReaderLimits& limits = {});

/// What of a Lisp file is meant, and the marks of Lisp's reader that stand in it.
struct LispFile {
  /// Heads of the lists that are meant. In lists outside of them, which are to be passed over, all
  /// that Lisp's reader knows is read, if only as names.
  std::vector<std::string_view> definitions;
  std::vector<Place> skipped;  ///< `#+feature form` (or `#-`), whose form is left out
  std::vector<Place> kept;     ///< those whose form is read
};

/// As ReadData, of a whole Lisp file. It is read where no feature is there, so that `#+feature
/// form` is left out and of `#-feature form` the form is read; features may be (not f), (and f...),
/// (or f...). @param file  takes the marks.
std::vector<Datum> ReadLispFile(std::string_view text, const std::string& source, LispFile* file);

/// A name without the package before it: `defdomain` of `shop2:defdomain`. Keywords stay.
std::string_view WithoutPackage(std::string_view name);

/// The symbol after the first parenthesis, which tells what kind of file it is; "" if there is
/// none. Reads no further. @throws base::ConfigError as above.
std::string FirstWord(std::string_view text, const std::string& source);

/// A datum for a message: on one line, at most 60 bytes, cut where it is longer. Takes no longer
/// for a huge datum than for a small one.
std::string Excerpt(const Datum& datum);

/// "source:line:column: text".
std::string Located(const std::string& source, Place place, const std::string& text);

/// Throws "source:line:column: text" as ConfigError, for code that interprets the data.
[[noreturn]] void FailAt(const std::string& source, Place place, const std::string& text);

}  // namespace hires::planning
