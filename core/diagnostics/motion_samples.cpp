// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/motion_samples.hpp"

#include <memory>
#include <string>

#include "core/diagnostics/books.hpp"
#include "core/diagnostics/peaks.hpp"

namespace unfurl {

namespace {

thread_local bool (*looked_enough)() = nullptr;

}  // namespace

LooksUntil::LooksUntil(bool (*enough)()) {
  looked_enough = enough;
}
LooksUntil::~LooksUntil() {
  looked_enough = nullptr;
}

const MotionSamples::Sample* MotionSamples::find(const Key& key) const {
  const auto known = kept_.find(key);
  return known == kept_.end() ? nullptr : &known->second;
}

const MotionSamples::Sample& MotionSamples::keep(Key key, Sample sample) {
  constexpr std::size_t room = std::size_t{1} << 21U, always = 4;  // numbers: 16 MB; of large structures
  const Trajectory& states = sample.piece.trajectory;
  std::size_t numbers = 0;
  for (std::size_t i = 0; i < states.size(); ++i)
    numbers += 2 * static_cast<std::size_t>(states.state(i).z.size()) + states.structure().rods.size();
  if (numbers_ + numbers > room && kept_.size() >= always) return last_.emplace(std::move(sample));
  numbers_ += numbers;
  const Sample& kept = kept_.insert_or_assign(std::move(key), std::move(sample)).first->second;
  pieces_.insert(&kept.piece);
  return kept;
}

namespace {

Diagnostics judged_as(const Simulation& piece, MotionSamples::Of what) {
  return what == MotionSamples::Of::energies ? diagnose_energies(piece)
                                             : diagnose_states(piece, what == MotionSamples::Of::reactions);
}

}  // namespace

const Diagnostics& MotionSamples::of(const Simulation& piece, Of what) {
  if (!pieces_.contains(&piece)) return last_found_ = judged_as(piece, what);
  const auto known = found_.find({&piece, what});
  return known != found_.end()
             ? known->second
             : found_.emplace(std::pair(&piece, what), judged_as(piece, what)).first->second;
}

MotionSamples::Of table_of(const Series& column) {
  if (column.unit == "J") return MotionSamples::Of::energies;
  const bool reaction = column.name.find(".reaction_") != std::string::npos;
  return reaction ? MotionSamples::Of::reactions : MotionSamples::Of::motion;
}

bool of_the_state(const Series& column) {
  if (column.unit == "J") return column.name == "kinetic_energy_J" || column.name == "potential_energy_J";
  return !column.name.starts_with("constraint_") && !column.name.ends_with("_unique") &&
         column.name != "step_s" && column.name != "newton_iterations";
}

const Simulation& inside_step(const Simulation& run, std::size_t k,
                              std::optional<MotionSamples::Sample>& made) {
  const Trajectory& states = run.trajectory;
  std::vector<double> times;
  for (const double u : {0.25, 0.5, 0.75})
    times.push_back(states.time(k) + u * (states.time(k + 1) - states.time(k)));
  MotionSamples* const samples = remembered_samples();
  MotionSamples::Key key(&run, k, true, times);
  if (const MotionSamples::Sample* known = samples ? samples->find(key) : nullptr) return known->piece;
  made.emplace(MotionSamples::Sample{
      {.trajectory = Trajectory({std::shared_ptr<const Model>(), &states.model(k)}), .options = run.options},
      {}});
  for (const double t : times) made->piece.trajectory.append(states.state_at(t), StepReport{});
  return samples ? samples->keep(std::move(key), std::move(*made)).piece : made->piece;
}

void MotionSamples::move_onto_constraints(const Model& model, State& state) {
  if (projected_ != &model) projector_.emplace(model.system);
  projected_ = &model;
  (*projector_)(state);
}

void move_onto_constraints(const Model& model, State& state) {
  if (MotionSamples* const samples = remembered_samples())
    return samples->move_onto_constraints(model, state);
  project(model.system, state);
}

const Diagnostics& judged_piece(const Simulation& piece, MotionSamples::Of what, Diagnostics& made) {
  if (looked_enough && looked_enough()) throw LookedEnough();
  if (MotionSamples* const samples = remembered_samples()) return samples->of(piece, what);
  return made = judged_as(piece, what);
}

}  // namespace unfurl
