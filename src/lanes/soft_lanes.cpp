#include "carom/lanes/soft_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "carom/base/elementary.hpp"
#include "carom/integrators/scheme.hpp"
#include "events/group.hpp"
#include "forces/potential.hpp"
#include "integrators/stages.hpp"
#include "lanes/soft_pack.hpp"

namespace carom {

using geometry::Cell;
using geometry::Vector;
using lanes::SoftForces;
using lanes::SoftKernel;
using lanes::SoftPack;
using lanes::SoftStage;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
constexpr int steps_between_questions = 64;

SoftKernel kernel_for(InstructionSet set) {
  if (!available(set)) throw std::invalid_argument("this machine does not have the instruction set");
#if defined(CAROM_WIDE_LANES)
  if (set == InstructionSet::avx512) return lanes::avx512_soft_kernel();
  if (set == InstructionSet::avx2) return lanes::avx2_soft_kernel();
#endif
  return lanes::baseline_soft_kernel();
}

SoftStage::Kind kind_of(Stage<double>::Kind kind) {
  switch (kind) {
    case Stage<double>::Kind::drift:
      return SoftStage::Kind::drift;
    case Stage<double>::Kind::kick:
      return SoftStage::Kind::kick;
    case Stage<double>::Kind::straight:
      return SoftStage::Kind::straight;
    case Stage<double>::Kind::turn:
      break;
  }
  return SoftStage::Kind::turn;
}

}  // namespace

class SoftLanes::Implementation {
 public:
  Implementation(const Table& the_table, const Dynamics& dynamics, InstructionSet set)
      : table_(the_table),
        field_(*dynamics.forces),
        step_(dynamics.integrator.step),
        stages_(stages_of<double>(find_scheme(dynamics.integrator.scheme))),
        kernel_(kernel_for(set)) {
    forces_.exp = elementary::exp_by(kernel_.width);
    forces_.other = add_one_by_one;
    forces_.context = this;
    for (const auto& potential : field_.potentials())
      forces_.lattice[forces_.potentials++] = potential->lattice_field();
    if (!table_.lattice) return;
    for (const geometry::CellEdge& e : table_.lattice->edges) {
      const Vector across = table_.lattice->translation(e.beyond);
      forces_.across_x[forces_.edges] = across.x;
      forces_.across_y[forces_.edges++] = across.y;
    }
    const Vector centre = centre_of_cell(*table_.lattice);
    forces_.centre_x = centre.x;
    forces_.centre_y = centre.y;
  }

  bool run(const Particle& kind, std::span<Walk> walks, double t_end, std::span<const double> times,
           const Sample& sample, const std::function<bool()>& interrupted) {
    particle_ = kind;
    forces_.unit_mass = kind.mass == 1.0;
    forces_.inverse_mass = 1.0 / kind.mass;
    for (std::size_t first = 0; first < walks.size(); first += SoftPack::lanes) {
      const std::size_t count = std::min<std::size_t>(SoftPack::lanes, walks.size() - first);
      if (!run_pack(walks.subspan(first, count), first, t_end, times, sample, interrupted)) return false;
    }
    return true;
  }

 private:
  bool run_pack(std::span<Walk> walks, std::size_t first, double t_end, std::span<const double> times,
                const Sample& sample, const std::function<bool()>& interrupted) {
    fill(walks);
    Time now;
    std::size_t next = 0;
    const auto emit = [&](const SoftPack& pack, const Time& t) {
      for (std::size_t k = 0; k < walks.size(); ++k)
        if (!walks[k].lost) sample(first + k, next, state_of(pack, k, t));
    };
    for (int steps = 1;; ++steps) {
      if (interrupted && steps % steps_between_questions == 0 && interrupted()) return false;
      const Time end = next_multiple(now, step_);
      const bool last = !(end <= Time(t_end));
      const auto due = [&](double t) { return last ? Time(t) <= Time(t_end) : Time(t) < end; };
      for (; next < times.size() && due(times[next]); ++next) {
        const double since = Time(times[next]) - now;
        if (since > 0.0) {
          SoftPack copy = pack_;
          take_step(since, copy);
          emit(copy, times[next]);
        } else {
          emit(pack_, times[next]);
        }
      }
      if (last) break;
      take_step(std::clamp(end - now, 0.0, std::numeric_limits<double>::max()), pack_);
      now = end;
      if (pack_.calls > 0) answer(walks);
    }
    for (std::size_t k = 0; k < walks.size(); ++k) walks[k].state = state_of(pack_, k, now);
    return true;
  }

  void fill(std::span<const Walk> walks) {
    pack_.count = (static_cast<int>(walks.size()) + 7) / 8 * 8;
    pack_.fresh = false;
    for (int lane = 0; lane < pack_.count; ++lane) {
      // Lanes that are left over repeat the first.
      const State& s = walks[at(lane) < walks.size() ? at(lane) : 0].state;
      pack_.x[lane] = s.position.x;
      pack_.y[lane] = s.position.y;
      pack_.vx[lane] = s.velocity.x;
      pack_.vy[lane] = s.velocity.y;
      cells_[lane] = s.cell;
      fold(lane);
    }
  }

  State state_of(const SoftPack& pack, std::size_t k, const Time& t) const {
    State s;
    s.position = {pack.x[k], pack.y[k]};
    s.velocity = {pack.vx[k], pack.vy[k]};
    s.cell = cells_[k];
    s.time = t;
    return s;
  }

  /// As SplittingStepper.
  void take_step(double duration, SoftPack& pack) {
    if (duration != made_for_ || particle_.omega != made_with_) {
      made_.clear();
      for (const Stage<double>& s : stages_)
        made_.push_back({kind_of(s.kind), s.coefficient * duration,
                         LarmorDrift<double>(particle_.omega, s.coefficient * duration)});
      made_for_ = duration;
      made_with_ = particle_.omega;
    }
    kernel_.step(forces_, made_.data(), static_cast<int>(made_.size()), pack);
  }

  /// Puts lanes back into the cell, and takes out those that are no numbers any more.
  void answer(std::span<Walk> walks) {
    SoftPack moved;
    for (int i = 0; i < pack_.calls; ++i) {
      const int lane = pack_.lane[i];
      const double size = (std::fabs(pack_.x[lane]) + std::fabs(pack_.y[lane])) +
                          (std::fabs(pack_.vx[lane]) + std::fabs(pack_.vy[lane]));
      if (!(size <= 1e100)) {
        if (at(lane) < walks.size()) walks[at(lane)].lost = true;
        pack_.x[lane] = pack_.y[lane] = pack_.vx[lane] = pack_.vy[lane] = 0.0;  // it goes on as anything
      }
      fold(lane);
      moved.x[i] = pack_.x[lane];
      moved.y[i] = pack_.y[lane];
    }
    if (!pack_.fresh) return;
    moved.count = (pack_.calls + 7) / 8 * 8;
    kernel_.evaluate(forces_, moved);
    for (int i = 0; i < pack_.calls; ++i) {
      pack_.ax[pack_.lane[i]] = moved.ax[i];
      pack_.ay[pack_.lane[i]] = moved.ay[i];
    }
  }

  void fold(int lane) {
    if (!table_.lattice) return;
    Vector x{pack_.x[lane], pack_.y[lane]};
    fold_towards_centre(*table_.lattice, {forces_.centre_x, forces_.centre_y}, x, cells_[lane]);
    pack_.x[lane] = x.x;
    pack_.y[lane] = x.y;
  }

  static void add_one_by_one(const SoftForces& forces, int potential, SoftPack& pack) {
    const auto& self = *static_cast<const Implementation*>(forces.context);
    const Potential& p = *self.field_.potentials()[at(potential)];
    for (int lane = 0; lane < pack.count; ++lane) {
      Vector force{pack.ax[lane], pack.ay[lane]};
      p.add_force(self.particle_, {pack.x[lane], pack.y[lane]}, force);
      pack.ax[lane] = force.x;
      pack.ay[lane] = force.y;
    }
  }

  const Table& table_;
  const ForceField& field_;
  double step_;
  std::vector<Stage<double>> stages_;
  SoftKernel kernel_;
  SoftForces forces_;
  SoftPack pack_;
  Cell cells_[SoftPack::lanes];
  Particle particle_;
  std::vector<SoftStage> made_;  ///< the stages of the latest step
  double made_for_ = 0.0, made_with_ = 0.0;
};

bool SoftLanes::suits(const Table& table, const Dynamics& dynamics) {
  const IntegratorPlan& plan = dynamics.integrator;
  if (!dynamics.forces || !dynamics.forces->external() || dynamics.forces->interacts()) return false;
  if (!dynamics.forces->disc_radii().empty() || !(dynamics.everywhere || dynamics.forces->everywhere()))
    return false;
  if (!table.walls.empty() || dynamics.forces->potentials().size() > SoftForces::most) return false;
  if (table.lattice && table.lattice->edges.size() > SoftForces::most_edges) return false;
  if (is_adaptive(plan.scheme) || plan.split_walls || !(plan.step > 0.0)) return false;
  return find_scheme(plan.scheme).form != Scheme::Form::spreiter_walter;
}

SoftLanes::SoftLanes(const Table& table, const Dynamics& dynamics, InstructionSet set)
    : implementation_(std::make_unique<Implementation>(table, dynamics, set)) {}
SoftLanes::~SoftLanes() = default;
SoftLanes::SoftLanes(SoftLanes&&) noexcept = default;

bool SoftLanes::run(const Particle& kind, std::span<Walk> walks, double t_end, std::span<const double> times,
                    const Sample& sample, const std::function<bool()>& interrupted) {
  return implementation_->run(kind, walks, t_end, times, sample, interrupted);
}

}  // namespace carom
