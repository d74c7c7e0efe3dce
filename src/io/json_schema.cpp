#include "io/json_schema.hpp"

#include "io/units.hpp"
#include "text/number.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr const char* kNumber = R"(^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*)";

Json either(const Json& first, const Json& second) {
  return Json{{"anyOf", Json::array({first, second})}};
}

// A number followed by a unit; of products of units only the number is checked.
Json quantity_text(const std::string& unit) {
  const std::string units = joined(units_like(unit), "|");
  return {{"type", "string"},
          {"pattern", kNumber + (units.empty() ? "\\S.*$" : "(" + units + ")\\s*$")}};
}

Json bounded(Json schema, const TomlKey& key) {
  const auto number = [&](double bound) {
    return key.kind == TomlKey::Kind::whole ? Json(static_cast<std::int64_t>(bound)) : Json(bound);
  };
  if (std::isfinite(key.low)) schema["minimum"] = number(key.low);
  if (std::isfinite(key.high)) schema["maximum"] = number(key.high);
  return schema;
}

// "simulated time; in s; default 600"
std::string description_of(const TomlKey& key) {
  std::string out = key.meaning;
  if (!key.unit.empty() && key.unit != "1") out += "; in " + key.unit;
  if (!key.standard.empty() && key.standard != "\"\"") out += "; default " + key.standard;
  return out;
}

Json object_of(const TomlKeys& keys);

Json schema_of(const TomlKey& key) {
  const Json text{{"type", "string"}}, number{{"type", "number"}};
  switch (key.kind) {
    case TomlKey::Kind::text:
      return text;
    case TomlKey::Kind::texts:
      return either(text, {{"type", "array"}, {"items", text}, {"minItems", 1}});
    case TomlKey::Kind::flag:
      return {{"type", "boolean"}};
    case TomlKey::Kind::on_off:
      return either({{"type", "boolean"}}, {{"enum", {"on", "off"}}});
    case TomlKey::Kind::whole:
      return bounded({{"type", "integer"}}, key);
    case TomlKey::Kind::number:
      return either(bounded(number, key), quantity_text(key.unit));
    case TomlKey::Kind::quantity:
      return either(number, quantity_text(""));
    case TomlKey::Kind::word: {
      Json words = Json::array();
      for (const std::string& word : key.words) {
        if (!word.empty()) words.push_back(word);
      }
      return {{"enum", words}};
    }
    case TomlKey::Kind::list:
      return {{"type", "array"}, {"minItems", 1}};
    case TomlKey::Kind::numbers:
      return {{"type", "array"}, {"items", number}};
    case TomlKey::Kind::figures: {
      const Json one = either(number, quantity_text(""));
      return {{"anyOf",
               {number,
                quantity_text(""),
                {{"type", "array"}, {"items", one}},
                {{"type", "object"}, {"additionalProperties", one}}}}};
    }
    case TomlKey::Kind::table:
      return object_of(key.keys);
    case TomlKey::Kind::tables:
      return {{"type", "array"}, {"items", object_of(key.keys)}};
    default:
      return {{"type", "object"}, {"additionalProperties", object_of(key.keys)}};
  }
}

Json object_of(const TomlKeys& keys) {
  Json out{{"type", "object"}, {"additionalProperties", false}};
  Json needed = Json::array();
  out["properties"] = Json::object();
  for (const TomlKey& key : keys) {
    Json value = schema_of(key);
    if (!key.meaning.empty()) value["description"] = description_of(key);
    out["properties"][key.name] = std::move(value);
    if (key.needed) needed.push_back(key.name);
  }
  if (!needed.empty()) out["required"] = std::move(needed);
  return out;
}

}  // namespace

Json json_schema(const std::string& title, const TomlKeys& keys) {
  Json out{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  out.update(object_of(keys));
  return out;
}

}  // namespace lilytank
