// A proposed experiment in words and as a file.
#include "io/scenario_text.hpp"
#include "lilytank/next_experiment.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

std::string minutes_of(double minutes, int count, const std::string& one, const std::string& many) {
  return significant(minutes, 2) + " min of " + std::to_string(count) + " " +
         (count == 1 ? one : many);
}

std::string lilies_of(const ProposedExperiment& p) {
  return p.minutes > 0 ? minutes_of(p.minutes, p.modules, "Lily", "Lilies") : "";
}

std::string balls_of(const ProposedExperiment& p) {
  return p.ball_minutes > 0 ? minutes_of(p.ball_minutes, p.balls, "ball", "balls") : "";
}

// What is there, and how to go on.
std::string introduction(const std::string& name, const ProposedExperiment& p) {
  std::string out = "Proposed by lilytank diagnose of " + name + ": " + p.text() + ".\n";
  if (!p.pair.empty()) {
    out += "Expected information: " + significant(p.information, 2) + " nat, " + p.pair + "\n";
  }
  out += p.alone() ? "The pumps run at another power, at which the flow is measured anew.\n"
                   : "Pumps, water level and camera are those of the recordings before.\n";
  if (p.minutes > 0) out += "Latches are off.\n";
  return out + "Simulate it:  lilytank run EXPERIMENT.toml next_experiment.toml\n" +
         "Once filmed, name the files below, then:\n" +
         "              lilytank diagnose EXPERIMENT.toml next_experiment.toml";
}

void add_recording(ScenarioText& out, const std::string& file, const std::string& body,
                   const std::string& content) {
  out.table("[recording]");
  out.line("file", "\"" + file + "\"", content);
  out.line("body", "\"" + body + "\"");
  if (body == "lily") out.line("latches", "\"off\"");
}

}  // namespace

std::string ProposedExperiment::text() const {
  const bool both = minutes > 0 && ball_minutes > 0;
  std::string out = lilies_of(*this) + (both ? " and " : "") + balls_of(*this);
  if (alone()) out += ", pumps at " + significant(100 * power, 3) + " % of their power";
  return repeats ? out + ", as before" : out;
}

ProposedExperiment to_meet(const std::vector<Shortfall>& shortfalls) {
  ProposedExperiment out;
  for (const Shortfall& s : shortfalls) {
    const bool balls = s.body == BodyKind::ball;
    double& minutes = balls ? out.ball_minutes : out.minutes;
    (balls ? out.balls : out.modules) = s.count;
    minutes = std::fmax(minutes, std::ceil(s.minutes));
  }
  return out;
}

std::string next_experiment_toml(const std::string& name, const ProposedExperiment& p) {
  ScenarioText out;
  out.comment(introduction(name, p));
  out.number("run.duration", 60 * std::fmax(p.minutes, p.ball_minutes), "s");
  out.number("module.count", p.minutes > 0 ? p.modules : 0);
  if (p.minutes <= 0) out.number("ball.count", p.balls);
  if (p.alone()) out.comment("also set flow.pump_power");
  out.line("control.latches", "false");
  out.table("experiment");
  out.quoted("name", name + "-next");
  if (!p.alone()) out.line("further", "true", "beside the recordings of EXPERIMENT.toml");
  if (p.ball_minutes > 0) add_recording(out, "next_balls.csv", "ball", balls_of(p));
  if (p.minutes > 0) add_recording(out, "next_lilies.csv", "lily", lilies_of(p));
  return out.text();
}

}  // namespace lilytank
