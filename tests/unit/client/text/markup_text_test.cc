#include "client/text/markup_text.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

TEST(MarkupText, LeavesNothingThatATagOrAnAttributeCouldEndAt) {
  EXPECT_EQ(markup_text("a < b > c & \"d\" 'e' \xC3\xB6"),
            "a &lt; b &gt; c &amp; &quot;d&quot; &#39;e&#39; \xC3\xB6");
  EXPECT_EQ(markup_text("\xFF"), "\xEF\xBF\xBD");
}

}  // namespace
}  // namespace affskel::client
