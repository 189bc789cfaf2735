// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "engine/sources/live_posture.h"
#include "engine/step/live_player.h"
#include "engine/step/reach_player.h"
#include "engine/step/steer_player.h"
#include "engine/step/throw_player.h"

#include "core/engine/engine_log.h"

namespace marey::engine {

// Numbers and texts of requests, in the order of their members. An optional is a number 0
// or 1, and the value after 1. Every value is exact.

void write_fields(const ActionWish& wish, EngineRequest& out);
void write_fields(const SteerWish& wish, EngineRequest& out);
void write_fields(const ReachWish& wish, EngineRequest& out);
void write_fields(const ThrowWish& wish, EngineRequest& out);
void write_fields(const LiveWish& wish, EngineRequest& out);
void write_fields(const ReachTarget& target, EngineRequest& out);
void write_fields(const LivePosture& posture, EngineRequest& out);

/// Reads the output of write_fields(); nullopt: another number of values, or a number
/// that its member cannot have.
template <class Value>
[[nodiscard]] std::optional<Value> read_fields(const EngineRequest& request);

template <>
std::optional<ActionWish> read_fields(const EngineRequest& request);
template <>
std::optional<SteerWish> read_fields(const EngineRequest& request);
template <>
std::optional<ReachWish> read_fields(const EngineRequest& request);
template <>
std::optional<ThrowWish> read_fields(const EngineRequest& request);
template <>
std::optional<LiveWish> read_fields(const EngineRequest& request);
template <>
std::optional<ReachTarget> read_fields(const EngineRequest& request);
template <>
std::optional<LivePosture> read_fields(const EngineRequest& request);

}  // namespace marey::engine
