#include "lilytank/metrics.hpp"

namespace lilytank {

MsdCurve mean_squared_displacement(const Trajectory& t, int first, int bodies,
                                   const std::vector<int>& lags, Origins origins) {
  MsdCurve curve;
  const int frames = t.frames();
  const double interval = frames > 1 ? (t.time.back() - t.time.front()) / (frames - 1) : 0;
  for (const int lag : lags) {
    const int starts = origins == Origins::first ? std::min(1, frames - lag) : frames - lag;
    double sum = 0;
    std::int64_t count = 0;
    for (int f = 0; f < starts; ++f) {
      const std::size_t a = static_cast<std::size_t>(f) * t.bodies + first;
      const std::size_t b = a + static_cast<std::size_t>(lag) * t.bodies;
      for (int i = 0; i < bodies; ++i) {
        const double dx = static_cast<double>(t.x[b + i]) - static_cast<double>(t.x[a + i]);
        const double dy = static_cast<double>(t.y[b + i]) - static_cast<double>(t.y[a + i]);
        sum += dx * dx + dy * dy;
      }
      count += bodies;
    }
    curve.lag.push_back(lag * interval);
    curve.msd.push_back(count > 0 ? sum / static_cast<double>(count) : 0);
    curve.count.push_back(count);
  }
  return curve;
}

}  // namespace lilytank
