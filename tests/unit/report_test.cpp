// A report is one document: its text and its page hold the same words, and the page is safe to
// open.
#include "lilytank/report.hpp"

#include <gtest/gtest.h>

namespace lilytank {
namespace {

ReportDocument sample() {
  ReportDocument r;
  r.title = "Diagnosis of <script>alert(1)</script> & \"quotes\"";
  r.subtitle = "2 recordings";
  r.card = {
      ReportTone::finding, "omitted effect: coriolis", {{"size", "rate = 0.5 [0.4, 0.6] 1/s"}}};
  r.sections.push_back({"coriolis",
                        {"F = m rate z x v"},
                        {{"parameter", "value"}, {{"rate", "0.5"}}},
                        {"below"},
                        false});
  r.sections.push_back({"Ranking", {}, {{"effect", "z"}, {{"coriolis", "7"}}}, {}, true});
  r.warnings = {"short <recordings>"};
  r.provenance = {"lilytank diagnose a.toml", "0.1.0", "1", {{"a.toml", "0123"}}};
  return r;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(ReportDocument, TextAndPageHoldTheSame) {
  const std::string text = report_text(sample()), page = report_html(sample(), {});
  for (const char* part :
       {"2 recordings", "omitted effect: coriolis", "rate = 0.5 [0.4, 0.6] 1/s", "F = m rate z x v",
        "parameter", "below", "Ranking", "lilytank diagnose a.toml", "0123", "a.toml"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_NE(text.find("warning: short <recordings>\n"), std::string::npos) << text;
}

TEST(ReportDocument, NamesFromInputAreEscapedOnThePage) {
  const std::string page =
      report_html(sample(), {{"<svg width=\"9\"><g id=\"a\"/></svg>", "f", "\"<b>"}});
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("<recordings>"), std::string::npos);
  EXPECT_NE(page.find("aria-label=\"&quot;&lt;b&gt;\""), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;quotes&quot;"),
            std::string::npos);
}

TEST(ReportDocument, PicturesKeepTheirIdsApartAndHaveAlternativeTexts) {
  const std::string svg =
      "<?xml version=\"1.0\"?>\n<svg><g id=\"glyph\"/><use href=\"#glyph\"/>"
      "<text>url(#7)</text></svg>";
  const std::string page = report_html(sample(), {{svg, "one", "First"}, {svg, "two", "Second"}});
  EXPECT_EQ(count(page, "role=\"img\" aria-label="), 2u);
  EXPECT_EQ(count(page, "id=\"one-glyph\""), 1u);
  EXPECT_EQ(count(page, "href=\"#two-glyph\""), 1u);
  EXPECT_EQ(count(page, "<text>url(#7)</text>"), 2u);
  EXPECT_EQ(page.find("<?xml"), std::string::npos);
}

TEST(ReportDocument, DetailsAreFoldedAndLast) {
  const std::string page = report_html(sample(), {});
  EXPECT_EQ(count(page, "<details>"), 1u);
  EXPECT_LT(page.find("F = m rate"), page.find("<details>"));
  EXPECT_LT(page.find("Warnings"), page.find("F = m rate"));
}

}  // namespace
}  // namespace lilytank
