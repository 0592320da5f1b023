#pragma once

#include <tinyxml2.h>

#include <algorithm>

namespace hires::world {

/// Prints elements in the lines that they came from, for the sake of messages.
class LineKeepingPrinter : public tinyxml2::XMLPrinter {
 public:
  LineKeepingPrinter() : tinyxml2::XMLPrinter(nullptr, true) {}

  void Open(const tinyxml2::XMLElement& element) {
    GoToLineOf(element);
    OpenElement(element.Name(), true);
    for (const auto* given = element.FirstAttribute(); given != nullptr; given = given->Next()) {
      PushAttribute(given->Name(), given->Value());
    }
  }
  bool VisitEnter(const tinyxml2::XMLElement& element,
                  const tinyxml2::XMLAttribute* first) override {
    GoToLineOf(element);
    return XMLPrinter::VisitEnter(element, first);
  }
  using XMLPrinter::VisitEnter;

 protected:
  void Write(const char* data, std::size_t size) override {
    line_ += static_cast<int>(std::count(data, data + size, '\n'));
    XMLPrinter::Write(data, size);
  }
  void Putc(char character) override {
    line_ += character == '\n' ? 1 : 0;
    XMLPrinter::Putc(character);
  }

 private:
  void GoToLineOf(const tinyxml2::XMLElement& element) {
    while (line_ < element.GetLineNum()) Putc('\n');
  }

  int line_{1};
};

}  // namespace hires::world
