#include "base/files/plain_xml.h"

#include <gmock/gmock.h>

#include "support/messages.h"

namespace hires::base::plain_xml_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::HasSubstr;

TEST(PlainXmlTest, CommentsAndInstructionsBecomeBlanksOfTheSameSize) {
  EXPECT_EQ(PlainXml("<!-- a\n-- b --><?xml v?>\n<a>1<!--x--></a>", "f"),
            "      \n                 \n<a>1        </a>");
  EXPECT_EQ(PlainXml("<!DOCTYPE a [<!ENTITY b '>'> ]><a/>", "f"), std::string(31, ' ') + "<a/>");
  EXPECT_EQ(PlainXml("<a><![CDATA[<!-- no comment -->]]></a>", "f"),
            "<a><![CDATA[<!-- no comment -->]]></a>");
  EXPECT_EQ(PlainXml("\xEF\xBB\xBF<a/>", "f"), "   <a/>");
}

TEST(PlainXmlTest, WhatDoesNotEndIsNamedWithItsLine) {
  for (const std::string bad : {"\n\n<!-- a", "\n\n<?xml", "\n\n<![CDATA[", "\n\n<!DOCTYPE [ "}) {
    EXPECT_THAT(ConfigErrorOf([&] { PlainXml(bad, "a.world"); }), HasSubstr("a.world:3")) << bad;
  }
  EXPECT_THAT(ConfigErrorOf([&] { PlainXml("\xFF\xFE<", "a.world"); }), HasSubstr("UTF-8"));
}

}  // namespace
}  // namespace hires::base::plain_xml_test
