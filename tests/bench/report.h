#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "machine.h"
#include "result.h"

namespace affskel::bench {

/// One line about a row, for progress.
std::string summary(const RowResult& result);

/// The whole report as a Markdown page: the machine, the table, growth, memory, targets, how it was done.
std::string markdown(const Machine& machine, std::span<const RowResult> results);

/// The same as JSON: machine, rows, growth, targets.
nlohmann::json report_json(const Machine& machine, std::span<const RowResult> results);

}  // namespace affskel::bench
