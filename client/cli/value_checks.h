#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace affskel::client {

// What the values of options may be.

/// One of `words`, which its description lists as "{a,b,c}"; a word that is not is refused with the nearest.
CLI::Validator one_of(std::vector<std::string> words);
/// A finite number.
CLI::Validator finite_number();
/// A finite number above 0.
CLI::Validator positive_number();
/// The same, or a share between 0 and 1 with its sign: "1%".
CLI::Validator positive_number_or_share();
/// "0.1" or "10%", above 0 and below 1; rewrites it to a number.
CLI::Validator proper_share();
/// The same where all of it (100%) may be meant.
CLI::Validator share_or_all();
/// A whole number from `low` to `high`.
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high);
/// A whole number of bytes, or of powers of 1024 with K, M or G behind it; rewrites it to bytes.
CLI::Validator byte_count();
/// Not empty: a variable that is empty by mistake in a script must not select another server or file.
CLI::Validator non_empty();
/// Well-formed UTF-8: for what becomes a string of the protocol.
CLI::Validator utf8_text();
/// What may be an id of a job; a file that is there, whose mesh may be meant, is told to be submitted first.
CLI::Validator job_id();
/// A direction set; rewrites it to its one spelling.
CLI::Validator direction_set();

/// Takes every text that is not empty; marks an argument as the file of a mesh, for completions.
CLI::Validator mesh_file();
/// Whether mesh_file() marks it.
bool is_mesh_file(const CLI::Option& option);

}  // namespace affskel::client
