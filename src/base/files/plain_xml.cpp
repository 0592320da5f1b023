#include "base/files/plain_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/files/entities.h"
#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

/// Spaces instead of all but line breaks.
void Blank(std::size_t begin, std::size_t end, std::string* text) {
  for (std::size_t i = begin; i < end; ++i) {
    if ((*text)[i] != '\n' && (*text)[i] != '\r') (*text)[i] = ' ';
  }
}

std::size_t EndOf(const char* closing, std::size_t begin, const char* what, const std::string& text,
                  const std::string& path) {
  const std::size_t end = text.find(closing, begin);
  if (end != std::string::npos) return end + std::string(closing).size();
  throw ConfigError(fmt::format(
      "{}:{}: not well-formed XML: a {} begins here that does not end; close it by {}", path,
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n'), what,
      closing));
}

/// Behind the ">" of a document type, which may hold declarations in brackets.
std::size_t EndOfDocumentType(std::size_t begin, const std::string& text, const std::string& path) {
  const std::size_t bracket = text.find('[', begin);
  const std::size_t end = EndOf(">", begin, "document type", text, path);
  if (bracket == std::string::npos || bracket > end) return end;
  return EndOf(">", EndOf("]", bracket, "document type", text, path), "document type", text, path);
}

bool IsAt(std::size_t at, const char* start, const std::string& text) {
  return text.compare(at, std::string(start).size(), start) == 0;
}

}  // namespace

std::string PlainXml(std::string text, const std::string& path) {
  RefuseUtf16(text, path);
  RefuseEntities(text, path);
  if (IsAt(0, "\xEF\xBB\xBF", text)) Blank(0, 3, &text);
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) {
    std::size_t end = at;
    if (IsAt(at, "<!--", text)) {
      end = EndOf("-->", at, "comment", text, path);
    } else if (IsAt(at, "<?", text)) {
      end = EndOf("?>", at, "processing instruction", text, path);
    } else if (IsAt(at, "<!DOCTYPE", text)) {
      end = EndOfDocumentType(at, text, path);
    }
    Blank(at, end, &text);
    if (end == at)
      end = IsAt(at, "<![CDATA[", text) ? EndOf("]]>", at, "CDATA", text, path) : at + 1;
    at = end;
  }
  return text;
}

}  // namespace hires::base
