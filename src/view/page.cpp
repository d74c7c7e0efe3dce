#include "view/page.hpp"

#include "lilytank/view.hpp"
#include "text/words.hpp"
#include "view/tank_json.hpp"

namespace lilytank {
namespace {

/// JSON inside of a script element, which a '<' in a name could end.
std::string script_json(const Json& value) {
  std::string out;
  for (const char c : json_line(value)) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

Json yield_json(const ViewYield& yield) {
  return {{"name", yield.name},
          {"time", yield.band.time},
          {"mean", yield.band.mean},
          {"low", yield.band.low},
          {"high", yield.band.high}};
}

}  // namespace

std::string view_html(const ViewPage& page, const ViewOptions& options) {
  ViewPack pack;
  Json head{{"title", page.title},
            {"subtitle", page.subtitle},
            {"version", page.version},
            {"command", page.command},
            {"position_step", kViewPositionStep},
            {"heading_step", kViewHeadingStep}};
  head["tanks"] = Json::array(), head["yields"] = Json::array();
  for (const ViewTank& tank : page.tanks) {
    head["tanks"].push_back(tank_json(tank, options.rate, pack));
  }
  for (const ViewYield& yield : page.yields) head["yields"].push_back(yield_json(yield));
  std::string out;
  std::string_view rest = kPlayerPage;
  const auto put_at = [&](std::string_view mark, std::string_view text) {
    const auto at = rest.find(mark);
    out.append(rest.substr(0, at)).append(text);
    rest.remove_prefix(at + mark.size());
  };
  put_at("{{title}}", escaped(page.title));
  put_at("{{style}}", kPlayerStyle);
  put_at("{{head}}", script_json(head));
  put_at("{{data}}", pack.text());
  put_at("{{script}}", kPlayerScript);
  return out.append(rest);
}

}  // namespace lilytank
