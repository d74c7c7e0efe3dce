// The files of a diagnosis.

#include <cmath>

#include "io/atomic_file.hpp"
#include "io/json.hpp"
#include "jobs/job_directory.hpp"
#include "lilytank/diagnosis.hpp"
#include "text/number.hpp"

namespace lilytank {
namespace {

Json finding_json(const DiagnosisFinding& f) {
  Json out{{"effect", f.effect}, {"alternatives", f.alternatives}, {"confidence", f.confidence}};
  out["where"] = {
      {"variable", f.variable}, {"from", f.from}, {"to", f.to}, {"unit", f.unit}, {"text", f.text}};
  out["equation"] = f.equation, out["split"] = f.split;
  out["parameters"] = Json::array();
  for (const FoundParameter& p : f.parameters) {
    out["parameters"].push_back(
        {{"name", p.name}, {"value", p.value}, {"low", p.low}, {"high", p.high}, {"unit", p.unit}});
  }
  if (!std::isnan(f.gain)) {
    out["held_out"] = {{"log_likelihood_gain", f.gain},
                       {"low", f.gain_low},
                       {"high", f.gain_high},
                       {"unit", "nat"}};
  }
  return out;
}

Json proposal_json(const ProposedExperiment& one) {
  return {{"text", one.text()},
          {"modules", one.modules},
          {"lily_min", one.minutes},
          {"balls", one.balls},
          {"ball_min", one.ball_minutes},
          {"pump_power", one.power},
          {"information", one.information},
          {"pair", one.pair},
          {"per_minute", one.relative}};
}

std::string number(double value) {
  return significant(value, 6);
}

std::string maps_csv(const Diagnosis& d) {
  std::string out = "variable,direction,at,unit,value,deviation,value_unit,curve_z\n";
  for (const FoundCurve& c : d.maps) {
    for (std::size_t k = 0; k < c.at.size(); ++k) {
      out += c.variable + "," + c.direction + "," + number(c.at[k]) + "," + c.unit + "," +
             number(c.value[k]) + "," + number(c.deviation[k]) + "," + c.value_unit + "," +
             number(c.z) + "\n";
    }
  }
  return out;
}

std::string places_csv(const Diagnosis& d) {
  std::string out;
  for (const DiagnosisFinding& f : d.findings) {
    for (const PlaceMap::Place& place : f.places.places) {
      for (std::size_t c = 0; c < place.value.size(); ++c) {
        out += f.effect + "," + number(place.x) + "," + number(place.y) + "," +
               number(f.places.width) + "," + f.places.components[c] + "," +
               number(place.value[c]) + "," + f.places.units[c] + "," + number(place.z) + "\n";
      }
    }
  }
  return out.empty() ? out : "effect,x,y,width,component,value,unit,z\n" + out;
}

std::string ranking_csv(const Diagnosis& d) {
  std::string out = "effect,variant,z\n";
  for (const RankedEffect& r : d.ranking) {
    out += r.effect + ",\"" + r.variant + "\"," + number(r.z) + "\n";
  }
  return out;
}

std::string fit_csv(const Diagnosis& d) {
  std::string out = "numbers,before,after,chance,deviation_of_chance,share_removed\n";
  for (const GroupFit& g : d.held_out) {
    out += g.group + "," + number(g.before) + "," + number(g.after) + "," + number(g.chance) + "," +
           number(g.deviation) + "," + number(g.removed()) + "\n";
  }
  return out;
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d) {
  Json out{{"schema", "diagnosis/1"}, {"name", d.name}, {"verdict", name_of(d.verdict)}};
  out["findings"] = Json::array();
  for (const DiagnosisFinding& f : d.findings) out["findings"].push_back(finding_json(f));
  out["fit"]["msd"] = {{"before", d.msd_before},
                       {"after", d.msd_after},
                       {"share_removed", d.msd_removed},
                       {"low", d.msd_low},
                       {"high", d.msd_high}};
  out["parameters"] = Json::array();
  for (const MovedParameter& p : d.parameters) {
    out["parameters"].push_back({{"path", p.path},
                                 {"alone", p.baseline},
                                 {"value", p.with_effects},
                                 {"low", p.low},
                                 {"high", p.high},
                                 {"unit", p.unit}});
  }
  for (const Shortfall& s : d.shortfalls) {
    out["shortfalls"].push_back({{"what", s.what}, {"record_min", s.minutes}, {"of", s.bodies()}});
  }
  for (const ProposedExperiment& one : d.next) out["next"].push_back(proposal_json(one));
  out["detectable"] = Json::array();
  for (const Detectable& one : d.detectable) {
    out["detectable"].push_back({{"effect", one.effect},
                                 {"parameter", one.parameter()},
                                 {"smallest", one.smallest},
                                 {"tried", one.tried},
                                 {"unit", one.unit}});
  }
  return json_text(out);
}

std::vector<std::string> diagnosis_files() {
  return with_figures(
      {"diagnosis.json", "diagnosis.txt", "missing.toml", "next_experiment.toml", "flow.csv",
       "maps.csv", "places.csv", "ranking.csv", "fit.csv", "report.html", "view.html"},
      {"laws", "places", "fit", "maps"});
}

std::vector<std::string> write_diagnosis(const Diagnosis& d, const ReportDocument& report,
                                         const std::string& dir) {
  std::vector<std::pair<std::string, std::string>> files{{"diagnosis.json", diagnosis_json(d)},
                                                         {"diagnosis.txt", report_text(report)}};
  if (!d.overlay.empty()) files.emplace_back("missing.toml", d.overlay);
  if (!d.next.empty()) {
    files.emplace_back("next_experiment.toml", next_experiment_toml(d.name, d.next.front()));
  }
  if (!d.flow_csv.empty()) files.emplace_back("flow.csv", d.flow_csv);
  if (!d.maps.empty()) files.emplace_back("maps.csv", maps_csv(d));
  const std::string places = places_csv(d);
  if (!places.empty()) files.emplace_back("places.csv", places);
  if (!d.ranking.empty()) files.emplace_back("ranking.csv", ranking_csv(d));
  if (!d.held_out.empty()) files.emplace_back("fit.csv", fit_csv(d));
  return write_files(dir, files);
}

}  // namespace lilytank
