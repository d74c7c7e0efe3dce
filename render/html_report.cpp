#include "html_report.hpp"

#include <filesystem>

#include "io/atomic_file.hpp"

namespace lilytank {
namespace {

namespace fs = std::filesystem;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

// A picture as text inside the page; ids of one picture must not be those of another.
std::string embedded(const std::string& file, const std::string& prefix) {
  std::string svg = read_whole(file);
  const auto begin = svg.find("<svg");
  if (begin == std::string::npos) return "";
  svg.erase(0, begin);
  for (const std::string mark : {"id=\"", "href=\"#", "url(#"}) {
    for (std::size_t at = svg.find(mark); at != std::string::npos;
         at = svg.find(mark, at + mark.size() + prefix.size())) {
      svg.insert(at + mark.size(), prefix);
    }
  }
  return svg;
}

}  // namespace

std::vector<std::string> write_html_report(const std::string& title,
                                           const std::vector<ReportFigure>& figures,
                                           const std::string& text, const std::string& dir) {
  std::vector<std::string> names;
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + escaped(title) +
      "</title>\n<style>body{font-family:sans-serif;max-width:70em;margin:2em auto;padding:0 1em;"
      "color:#222}pre{background:#f6f6f4;padding:1em;overflow-x:auto}figure{margin:2em 0}"
      "svg{max-width:100%;height:auto}figcaption{color:#555}</style></head>\n<body>\n<h1>" +
      escaped(title) + "</h1>\n";
  for (const ReportFigure& f : figures) {
    for (const char* ending : {".png", ".svg"}) {
      draw_plots(f.page, (fs::path(dir) / (f.name + ending)).string());
      names.push_back(f.name + ending);
    }
    html += "<figure>" + embedded((fs::path(dir) / (f.name + ".svg")).string(), f.name + "-") +
            "<figcaption>" + escaped(f.caption) + "</figcaption></figure>\n";
  }
  html += "<pre>" + escaped(text) + "</pre>\n</body></html>\n";
  write_atomically((fs::path(dir) / "report.html").string(), html);
  names.push_back("report.html");
  return names;
}

}  // namespace lilytank
