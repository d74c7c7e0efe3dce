// What the filter carries from frame to frame: modules, and assemblies of latched modules as one
// rigid body each.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lilytank/predictor.hpp"
#include "tracks/seen_bonds.hpp"

namespace lilytank {

/// Covariance of a coordinate and its velocity.
struct StateCovariance {
  double xx = 0, xv = 0, vv = 0;
  /// `kicks`: variance of the velocity's change in a second.
  void pass(double dt, double kicks) {
    xx += 2 * dt * xv + dt * dt * vv + kicks * dt * dt * dt / 3;
    xv += dt * vv + kicks * dt * dt / 2;
    vv += kicks * dt;
  }
  void see(double gain_x, double gain_v) {
    vv -= gain_v * xv, xv -= gain_x * xv, xx -= gain_x * xx;
  }
};

/// One module as the filter knows it.
struct Carried {
  const Track* track = nullptr;
  int module = 0;
  double x = 0, y = 0, theta = 0, vx = 0, vy = 0, omega = 0;
  StateCovariance place, turn;
  int begun = 0, seen = 0;  ///< frames
  int assembly = -1;        ///< number of the assembly that it is part of; -1: none
};

/// Noise of one module: variances of a measurement, and of the velocity's change in a second.
struct ModuleNoise {
  double place = 0, heading = 0, kicks = 0, turns = 0;
};

/// Modules that move as one rigid body on a square lattice of pitch `side`.
struct CarriedAssembly {
  std::vector<int> modules;  ///< identities, ascending
  std::vector<int> at;       ///< their numbers among the carried modules
  std::vector<int> cell_x, cell_y, turn;
  std::vector<unsigned> covered;     ///< bit f: a neighbour covers face f
  std::vector<double> arm_x, arm_y;  ///< m, from the centre of mass, in the assembly's frame
  double spread = 0;                 ///< m^2, sum of the squared arms
  double x = 0, y = 0, theta = 0, vx = 0, vy = 0, omega = 0;  ///< of the centre of mass
  StateCovariance place, rotation;
  int begun = 0;  ///< frame
  double size() const { return static_cast<double>(modules.size()); }
};

/// The assemblies that stand at a frame.
class CarriedAssemblies {
 public:
  CarriedAssemblies(const Model& model, const ModuleNoise& noise) : model_(model), noise_(noise) {}

  /// Groups the carried modules by the bonds that stand at a frame: {a, b} by identity. Modules of
  /// an assembly that came apart go on as it moved, as if just seen for the first time.
  void regroup(const std::vector<std::pair<int, int>>& bonds, int frame,
               std::vector<Carried>& carried);
  std::vector<CarriedAssembly>& all() { return all_; }

  /// A predicted assembly; `frame` has the innovations of its members. `usable_from`: s that the
  /// filter takes to settle.
  PredictedAssembly seen(CarriedAssembly& a, const PredictedFrame& frame, double dt,
                         double usable_from) const;
  /// Corrects an assembly, and its members with it.
  void correct(CarriedAssembly& a, const Innovation& by, std::vector<Carried>& carried) const;

 private:
  bool form(const std::vector<int>& modules, const std::vector<std::pair<int, int>>& bonds,
            int frame, const std::vector<Carried>& carried, CarriedAssembly& out) const;
  void take_motion(const std::vector<const Carried*>& of, CarriedAssembly& out) const;
  double inertia(const CarriedAssembly& a) const;

  const Model& model_;
  ModuleNoise noise_;
  std::vector<CarriedAssembly> all_;
};

}  // namespace lilytank
