// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/window_solver.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>
#include <glm/geometric.hpp>

#include "reconstruct/posture/normal_matrix.h"
#include "reconstruct/posture/posture_terms.h"
#include "reconstruct/tags/tag_corner_cost.h"

namespace marey::reconstruct {
namespace {

// Webcams that start together are within a frame of each other.
constexpr double kOffsetSigmaS = 0.02;
// Two seconds of movement determine an offset to a fraction of a millisecond.
constexpr std::size_t kOffsetFrames = 60;
// After this many the joints move by less than a tenth of a millimetre.
constexpr int kWindowIterations = 10;
// Initial slip, and number of passes over all windows that improve it; each may triple
// it.
constexpr double kInitialSlip_m = 0.0005;
constexpr int kPasses = 3;

}  // namespace

WindowSolver::WindowSolver(const BodyModel& model,
                           std::span<const Camera> cameras,
                           const Sightings& sightings,
                           std::vector<double> offsets_s,
                           std::vector<bool> given,
                           std::vector<Posture>& postures)
    : model_(&model),
      cameras_(cameras),
      sightings_(&sightings),
      offsets_s_(std::move(offsets_s)),
      given_(std::move(given)),
      postures_(&postures),
      sigmas_(postures.size()),
      tag_sigmas_(postures.size()) {
  slips_m_.fill(kInitialSlip_m);
  clock_sigmas_s_.assign(offsets_s_.size(), 0.0);
  find_velocities();
}

void WindowSolver::find_velocities() {
  velocities_.assign(sightings_->frames.size(), {});
  const std::vector<Posture>& postures = *postures_;
  const std::size_t last = postures.size() - 1;
  for (std::size_t f = 0; f < postures.size(); ++f) {
    const std::size_t before = f > 0 ? f - 1 : 0;
    const std::size_t after = std::min(f + 1, last);
    const double dt = static_cast<double>(std::max<std::size_t>(1, after - before)) /
                      sightings_->rate.hz;
    for (const TagSighting& s : sightings_->frames[f]) {
      std::array<glm::dvec2, 4> v{};
      const auto a = predicted_corners_px(*model_, s, cameras_, postures[before]);
      const auto b = predicted_corners_px(*model_, s, cameras_, postures[after]);
      for (std::size_t c = 0; a && b && c < 4; ++c) v[c] = ((*b)[c] - (*a)[c]) / dt;
      velocities_[f].push_back(v);
    }
  }
}

/// Builds a window's problem and its residual_blocks_. The first `held` postures belong
/// to the past and do not move.
void WindowSolver::build(std::size_t first,
                         std::size_t count,
                         std::size_t held,
                         ceres::Problem& problem) {
  std::vector<Posture>& postures = *postures_;
  residual_blocks_.assign(count, {});
  for (std::size_t f = first; f < first + count; ++f) {
    const std::vector<TagSighting>& seen = sightings_->frames[f];
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const TagSighting& s = seen[i];
      const HumanBone bone = model_->bone(s.tag);
      const auto cameras = std::count_if(
          seen.begin(), seen.end(), [&](const TagSighting& t) { return t.tag == s.tag; });
      const TagSlip slip = tag_slip(*model_,
                                    s,
                                    cameras_,
                                    postures[f],
                                    slips_m_[index(bone)],
                                    static_cast<double>(cameras));
      const ceres::ResidualBlockId id = add_late_sighting(*model_,
                                                          s,
                                                          cameras_,
                                                          postures[f],
                                                          problem,
                                                          &offsets_s_[index(s.camera)],
                                                          velocities_[f][i],
                                                          slip);
      residual_blocks_[f - first].push_back({id, slip, bone});
    }
    add_posture_priors(postures[f], model_->lengths, problem);
    if (f >= first + 2) {
      add_smoothness(
          postures[f - 2], postures[f - 1], postures[f], sightings_->rate, problem);
    }
  }
  if (held == 0 && count > 1) {
    add_first_speed(postures[first], postures[first + 1], sightings_->rate, problem);
  }
  for (std::size_t f = first; f < first + count; ++f) {
    set_manifolds(postures[f], problem);
    if (f < first + held) set_posture_constant(postures[f], problem);
  }
}

void WindowSolver::hold_offsets(bool all, ceres::Problem& problem) {
  for (std::size_t c = 0; c < offsets_s_.size(); ++c) {
    double* offset_s = &offsets_s_[c];
    if (!problem.HasParameterBlock(offset_s)) continue;
    if (all || given_[c]) {
      problem.SetParameterBlockConstant(offset_s);
    } else {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ScalarPrior, 1, 1>(
                                   new ScalarPrior{0.0, kOffsetSigmaS}),
                               nullptr,
                               offset_s);
    }
  }
}

/// Returns the start of the interval of `count` frames in which corners move most.
std::size_t WindowSolver::fastest_interval(std::size_t count) const {
  std::vector<double> energy(velocities_.size() + 1, 0.0);
  for (std::size_t f = 0; f < velocities_.size(); ++f) {
    double here = 0.0;
    for (const auto& v : velocities_[f]) here += glm::dot(v[0], v[0]);
    energy[f + 1] = energy[f] + here;
  }
  std::size_t best = 0;
  for (std::size_t f = 0; f + count < energy.size(); ++f) {
    if (energy[f + count] - energy[f] > energy[best + count] - energy[best]) best = f;
  }
  return best;
}

void WindowSolver::estimate_offsets() {
  if (std::all_of(given_.begin(), given_.end(), [](bool g) { return g; })) return;
  const std::size_t count = std::min(postures_->size(), kOffsetFrames);
  const std::size_t first = fastest_interval(count);
  ceres::Problem problem;
  build(first, count, 0, problem);
  hold_offsets(false, problem);
  ceres::Solver::Options solver = solver_options(12);
  solver.function_tolerance = 1e-4;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  find_clock_sigmas(std::span(*postures_).subspan(first, count), problem);
  find_velocities();
}

/// Computes the Schur complement of the free clock offsets.
void WindowSolver::find_clock_sigmas(std::span<Posture> postures,
                                     ceres::Problem& problem) {
  using Sparse = Eigen::SparseMatrix<double>;
  std::vector<double*> blocks;
  for (Posture& posture : postures) {
    for (const PoseParameter parameter : kAllPoseParameters)
      blocks.push_back(posture.block(parameter));
  }
  std::vector<std::size_t> solved;
  for (std::size_t c = 0; c < offsets_s_.size(); ++c) {
    if (given_[c] || !problem.HasParameterBlock(&offsets_s_[c])) continue;
    blocks.push_back(&offsets_s_[c]);
    solved.push_back(c);
  }
  if (solved.empty()) return;
  const auto normal = normal_matrix(problem, std::move(blocks));
  if (!normal) return;
  const Sparse all(*normal);
  const Eigen::Index clocks = static_cast<Eigen::Index>(solved.size());
  const Eigen::Index rest = all.cols() - clocks;
  const Eigen::SimplicialLDLT<Sparse> of_postures(all.block(0, 0, rest, rest));
  if (of_postures.info() != Eigen::Success) return;
  const Eigen::MatrixXd cross = all.block(0, rest, rest, clocks);
  const Eigen::MatrixXd information =
      Eigen::MatrixXd(all.block(rest, rest, clocks, clocks)) -
      cross.transpose() * of_postures.solve(cross);
  const Eigen::MatrixXd covariance =
      information.ldlt().solve(Eigen::MatrixXd::Identity(clocks, clocks));
  for (std::size_t i = 0; i < solved.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    clock_sigmas_s_[solved[i]] = std::sqrt(std::max(0.0, covariance(at, at)));
  }
}

bool WindowSolver::solve(const WindowSize& size, const Progress& progress) {
  const int frames = static_cast<int>(postures_->size());
  double scale = 1.0;
  for (int i = 0; i < kPasses; ++i) {
    SlipEstimate estimate;
    const auto report_pass = [&](int done, int /*total*/) {
      if (progress) progress((i * frames + done) / kPasses, frames);
    };
    if (!pass(size, estimate, report_pass)) return false;
    if (i + 1 < kPasses) slips_m_ = estimate.improved(slips_m_);
    scale = estimate.scale();
  }
  for (BoneSigmas& sigmas : sigmas_) {
    for (double& sigma_m : sigmas) sigma_m *= scale;
  }
  for (TagSigmas& sigmas : tag_sigmas_) {
    for (double& sigma_m : sigmas) sigma_m *= scale;
  }
  return true;
}

bool WindowSolver::pass(const WindowSize& size,
                        SlipEstimate& estimate,
                        const Progress& progress) {
  const std::size_t frames = postures_->size();
  std::size_t first = 0;  // The first frame that is not yet final.
  while (first < frames) {
    const std::size_t held = std::min<std::size_t>(2, first);
    std::size_t count = std::min(size.frames, frames - first);
    // A short remainder does not get a window of its own.
    if (frames - first - count < size.overlap) count = frames - first;
    ceres::Problem problem;
    build(first - held, count + held, held, problem);
    hold_offsets(true, problem);
    ceres::Solver::Options solver = solver_options(kWindowIterations);
    solver.function_tolerance = 1e-5;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (!summary.IsSolutionUsable()) return false;
    const bool last = first + count == frames;
    const std::size_t done = last ? count : count - size.overlap;
    const std::span<Posture> moved = std::span(*postures_).subspan(first, count);
    const auto covariances = posture_covariances(moved, problem);
    if (!covariances) return false;
    for (std::size_t i = 0; i < done; ++i) {
      sigmas_[first + i] = bone_sigmas(*model_, moved[i], (*covariances)[i]);
      tag_sigmas_[first + i] =
          reconstruct::tag_sigmas(*model_, moved[i], (*covariances)[i]);
    }
    residual_blocks_.erase(residual_blocks_.begin(),
                           residual_blocks_.begin() + static_cast<std::ptrdiff_t>(held));
    if (!add_slip_evidence(
            first, std::span(*covariances).first(done), problem, estimate)) {
      return false;
    }
    first += done;
    progress(static_cast<int>(first), static_cast<int>(frames));
  }
  return true;
}

std::optional<double> WindowSolver::solve_again(std::size_t first,
                                                std::vector<Posture>& candidate) {
  std::vector<Posture>& postures = *postures_;
  const std::size_t before = std::min<std::size_t>(2, first);
  const std::size_t end = first + candidate.size();
  const std::size_t after = std::min<std::size_t>(2, postures.size() - end);
  ceres::Problem problem;
  build(first - before, before + candidate.size() + after, before, problem);
  for (std::size_t f = end; f < end + after; ++f)
    set_posture_constant(postures[f], problem);
  hold_offsets(true, problem);
  double cost_now = 0.0;
  if (!problem.Evaluate({}, &cost_now, nullptr, nullptr, nullptr)) return std::nullopt;
  const auto own = postures.begin() + static_cast<std::ptrdiff_t>(first);
  // The problem points into the postures.
  std::swap_ranges(candidate.begin(), candidate.end(), own);
  ceres::Solver::Options solver = solver_options(kWindowIterations);
  solver.function_tolerance = 1e-5;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  std::swap_ranges(candidate.begin(), candidate.end(), own);
  if (!summary.IsSolutionUsable()) return std::nullopt;
  return summary.final_cost - cost_now;
}

/// Adds the final frames' sightings to the slip estimate.
bool WindowSolver::add_slip_evidence(std::size_t first,
                                     std::span<const Eigen::MatrixXd> covariances,
                                     ceres::Problem& problem,
                                     SlipEstimate& estimate) {
  ceres::Problem::EvaluateOptions options;
  options.apply_loss_function = false;
  for (std::size_t f = 0; f < covariances.size(); ++f) {
    for (const PoseParameter parameter : kAllPoseParameters) {
      options.parameter_blocks.push_back((*postures_)[first + f].block(parameter));
    }
    for (const TagResidualBlock& w : residual_blocks_[f])
      options.residual_blocks.push_back(w.id);
  }
  if (options.residual_blocks.empty()) return true;
  std::vector<double> residuals;
  ceres::CRSMatrix crs;
  if (!problem.Evaluate(options, nullptr, &residuals, nullptr, &crs)) return false;
  int row = 0;
  for (std::size_t f = 0; f < covariances.size(); ++f) {
    const int before = static_cast<int>(f) * kPostureFreedom;
    for (const TagResidualBlock& w : residual_blocks_[f]) {
      Eigen::Matrix<double, 8, Eigen::Dynamic> jacobian =
          Eigen::Matrix<double, 8, Eigen::Dynamic>::Zero(8, kPostureFreedom);
      for (int i = 0; i < 8; ++i) {
        const auto from = static_cast<std::size_t>(row + i);
        for (int k = crs.rows[from]; k < crs.rows[from + 1]; ++k) {
          const auto at = static_cast<std::size_t>(k);
          jacobian(i, crs.cols[at] - before) = crs.values[at];
        }
      }
      const Eigen::Map<const Eigen::Matrix<double, 8, 1>> left(residuals.data() + row);
      estimate.add(w.bone, w.slip, left, jacobian, covariances[f]);
      row += 8;
    }
  }
  return true;
}

std::vector<double> WindowSolver::errors_px(std::size_t frame,
                                            std::size_t sighting) const {
  const TagSighting& s = sightings_->frames[frame][sighting];
  const auto predicted = predicted_corners_px(*model_, s, cameras_, (*postures_)[frame]);
  std::vector<double> errors;
  for (std::size_t c = 0; predicted && c < 4; ++c) {
    const glm::dvec2 drift =
        velocities_[frame][sighting][c] * offsets_s_[index(s.camera)];
    errors.push_back(glm::distance((*predicted)[c] + drift, s.detection->corners_px[c]));
  }
  return errors;
}

}  // namespace marey::reconstruct
