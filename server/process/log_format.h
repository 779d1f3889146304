#pragma once

#include <spdlog/formatter.h>

#include <memory>

namespace affskel::server {

/// One line per entry, whatever it quotes: control characters, which workers' messages and ids may hold,
/// become '?', so that nobody can write entries of his own into the log.
std::unique_ptr<spdlog::formatter> log_formatter();

}  // namespace affskel::server
