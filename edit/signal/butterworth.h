// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

namespace marey::edit {

/// Filters a channel in place by a low-pass Butterworth filter of the 4th order without
/// phase: one of the 2nd order, forwards and backwards (Winter 2009, section 2.2.4.4).
///
/// The cut-off is that of both passes: the gain there is 0.707 exactly. It is prewarped
/// for the bilinear transform, then divided by C = (sqrt 2 - 1)^(1/4), about 0.802. Both
/// ends are extended by 0.25 s, reflected through the end's sample, and each pass starts
/// in the steady state of its first sample. Linear in the samples; allocates the extended
/// channel. A channel of fewer than 2 samples is left as it is. Preconditions: 0 <
/// cutoff_hz < rate_hz / 2.
void filter_butterworth(std::span<double> channel, double cutoff_hz, double rate_hz);

/// Returns the cut-off [Hz] for a sampling rate: 0.071 rate - 0.00003 rate^2 (Yu et al.
/// 1999, equation for kinematic data). Increases up to 1183 Hz. Precondition: 0 < rate_hz
/// <= 1183.
[[nodiscard]] double yu_cutoff_hz(double rate_hz);

/// Returns the cut-off [Hz] of a channel by residual analysis (Winter 2009, section
/// 2.2.4.5). The root mean square of the part that the filter removes is computed for
/// cut-offs up to a quarter of the rate. The straight end of that curve is taken to be
/// noise; the cut-off is where the curve crosses the value of this line at 0 Hz. None if
/// the channel has fewer than 20 samples, is constant, or has no straight end. About 60
/// filter passes.
[[nodiscard]] std::optional<double> winter_cutoff_hz(std::span<const double> channel,
                                                     double rate_hz);

}  // namespace marey::edit
