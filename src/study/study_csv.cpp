#include <cmath>

#include "lilytank/study_summary.hpp"
#include "statistics/csv_cells.hpp"

namespace lilytank {
namespace {

// "setting,label" and a column an axis.
std::string setting_head(const StudySummary& s) {
  std::string head = "setting,label";
  for (const std::string& axis : s.axes) head += "," + cell(axis);
  return head;
}

std::string setting_cells(const StudySummary& s, std::size_t setting) {
  const SettingSummary& of = s.settings[setting];
  std::string out = std::to_string(setting) + "," + cell(of.label);
  for (std::size_t i = 0; i < s.axes.size(); ++i) {
    out += "," + (i < of.values.size() ? cell(of.values[i]) : "");
  }
  return out;
}

// The rows of one setting in summary.csv.
class SettingRows {
 public:
  SettingRows(const StudySummary& s, std::size_t setting, std::string& out)
      : start_(setting_cells(s, setting)),
        runs_(std::to_string(s.settings[setting].runs)),
        out_(out) {}
  void count(const std::string& metric, std::int64_t n) {
    out_ += start_ + "," + metric + ",,1," + std::to_string(n) + ",,," + runs_ + "\n";
  }
  void estimate(const std::string& metric, const std::string& k, const std::string& unit,
                const Estimate& e) {
    out_ += start_ + "," + metric + "," + k + "," + unit + "," + cells(e) + "," + runs_ + "\n";
  }

 private:
  std::string start_, runs_;
  std::string& out_;
};

std::string label_of(const StudySummary& s, int setting) {
  return setting < 0 ? "" : cell(s.settings[static_cast<std::size_t>(setting)].label);
}

std::string number_of(int setting) {
  return setting < 0 ? "" : std::to_string(setting);
}

}  // namespace

std::string summary_csv(const StudySummary& s) {
  std::string out = setting_head(s) + ",metric,k,unit,value,low,high,runs\n";
  for (std::size_t i = 0; i < s.settings.size(); ++i) {
    const SettingSummary& setting = s.settings[i];
    SettingRows rows(s, i, out);
    rows.count("finished", setting.runs);
    rows.count("diverged", setting.diverged);
    rows.count("illegal", setting.illegal);
    rows.count("possible", setting.possible);
    rows.estimate("copies", "", "1", setting.copies);
    if (setting.possible == 0) continue;
    const Estimate& rate = setting.rate;
    rows.estimate("full_yield", "", "1", setting.full_yield);
    rows.estimate("assembly_rate", "", "1/h",
                  {3600 * rate.value, 3600 * rate.low, 3600 * rate.high});
    for (const CopyTime& t : setting.times) {
      rows.estimate("reached", std::to_string(t.k), "1", t.reached);
    }
    for (const CopyTime& t : setting.times) {
      rows.estimate("restricted_mean_time", std::to_string(t.k), "s", t.restricted_mean);
    }
  }
  return out;
}

std::string yield_curve_csv(const StudySummary& s) {
  std::string out = setting_head(s) + ",time_s,copies,low,high\n";
  for (std::size_t i = 0; i < s.settings.size(); ++i) {
    const CurveBand& band = s.settings[i].yield;
    const std::string start = setting_cells(s, i);
    for (std::size_t j = 0; j < band.time.size(); ++j) {
      out += start + "," + cell(band.time[j]) + "," +
             cells({band.mean[j], band.low[j], band.high[j]}) + "\n";
    }
  }
  return out;
}

std::string survival_csv(const StudySummary& s) {
  std::string out = setting_head(s) + ",k,time_s,survival,low,high,at_risk,events,censored\n";
  for (std::size_t i = 0; i < s.settings.size(); ++i) {
    for (const CopyTime& t : s.settings[i].times) {
      const Survival& curve = t.survival;
      if (curve.time.empty()) continue;
      const std::string start = setting_cells(s, i) + "," + std::to_string(t.k) + ",";
      if (curve.time[0] > 0)
        out += start + "0,1,1,1," + std::to_string(curve.at_risk[0]) + ",0,0\n";
      for (std::size_t j = 0; j < curve.time.size(); ++j) {
        out += start + cell(curve.time[j]) + "," +
               cells({curve.survival[j], curve.low[j], curve.high[j]}) + "," +
               std::to_string(curve.at_risk[j]) + "," + std::to_string(curve.events[j]) + "," +
               std::to_string(curve.censored[j]) + "\n";
      }
    }
  }
  return out;
}

std::string comparisons_csv(const StudySummary& s) {
  std::string out =
      "test,k,a,b,label_a,label_b,pairs,unit,difference,low,high,chi_squared,degrees,p,p_holm,"
      "variance_saved\n";
  const auto settings = [&](int a, int b) {
    return number_of(a) + "," + number_of(b) + "," + label_of(s, a) + "," + label_of(s, b);
  };
  for (const SurvivalTest& t : s.survival_tests) {
    out += "log_rank," + std::to_string(t.k) + "," + settings(t.a, t.b) + ",,,,,," +
           (t.result.degrees > 0 ? cell(t.result.statistic) + "," + cell(t.result.degrees) + "," +
                                       cell(t.result.p) + "," + cell(t.adjusted_p)
                                 : std::string(",,,")) +
           ",\n";
  }
  for (const PairTest& t : s.pair_tests) {
    const std::string name = t.k == 0 ? "paired_copies," : "paired_time," + std::to_string(t.k);
    out += name + "," + settings(t.a, t.b) + "," + std::to_string(t.pairs) + "," +
           (t.k == 0 ? "1" : "s") + ",";
    out += (t.reached ? cells(t.result.difference) + ",,," + cell(t.result.p) + "," +
                            cell(t.adjusted_p) + "," + cell(t.result.saving)
                      : std::string(",,,,,,,")) +
           "\n";
  }
  return out;
}

}  // namespace lilytank
