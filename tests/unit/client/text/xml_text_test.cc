#include "client/text/xml_text.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

TEST(XmlText, LeavesNothingThatATagOrAnAttributeCouldEndAt) {
  EXPECT_EQ(xml_text("a < b > c & \"d\" 'e' \xC3\xB6"), "a &lt; b &gt; c &amp; &quot;d&quot; 'e' \xC3\xB6");
  EXPECT_EQ(xml_text("\xFF"), "\xEF\xBF\xBD");
}

}  // namespace
}  // namespace affskel::client
