#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hires::base {

std::string ToLower(std::string_view text);
std::vector<std::string> Split(std::string_view text, char separator);  ///< "" gives {""}
/// At white space; what stands between two double quotes holds together: `_world:="my lab/a.world"`
/// is one word, without the quotes. A quote without a second one is a letter.
std::vector<std::string> SplitWords(std::string_view text);
std::string Join(const std::vector<std::string>& parts, std::string_view separator);

/// The `known` names most like `name` by edit distance (case ignored), best first, each once; of
/// two as near the one that begins and ends alike. For messages.
std::vector<std::string> NearestNames(const std::string& name,
                                      const std::vector<std::string>& known,
                                      std::size_t at_most = 3);

/// "area 'x' is unknown; did you mean 'y' or 'z'?"; where nothing is like it, all that are known;
/// of more than 12 the nearest three, or `lister`.
/// @param lister  command that lists them: "hires list areas"; empty: there is none.
std::string UnknownName(std::string_view kind, const std::string& name,
                        const std::vector<std::string>& known, std::string_view lister = "");

/// A whole file as text.  @throws ConfigError naming the path when it is missing, no regular file,
/// unreadable or larger than `max_bytes`.
std::string ReadTextFile(const std::string& path, std::size_t max_bytes = 64u << 20);

/// Files that a Windows editor saved as "Unicode": letters of two bytes each, after a byte order
/// mark or with a zero in each of the first two.  @param path  for the message.
/// @throws ConfigError naming the path and what to do.
void RefuseUtf16(std::string_view text, const std::string& path);

/// All or nothing: a file of that name is replaced only when the new one is whole; of a link, the
/// file that it leads to. A device or a pipe (/dev/stdout) stays what it is, and takes the text.
/// @throws ConfigError naming the path if it cannot be written.
void ReplaceTextFile(const std::string& path, const std::string& text);

/// Whether ReplaceTextFile may be expected to do it, before hours of work end at it. Leaves what is
/// there as it is.  @throws ConfigError naming the path: it is a folder, or cannot be written.
void RequireReplaceable(const std::string& path);

}  // namespace hires::base
