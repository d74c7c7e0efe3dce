// A batch script for Slurm. No name in it can become a command or a directive: each is one quoted
// word on one line, in comments, too.
#include <algorithm>
#include <cstdio>

#include "lilytank/study.hpp"
#include "text/words.hpp"

namespace lilytank {
namespace {

constexpr std::size_t kLongestName = 100;  // bytes of a job's name

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

bool has_control(const std::string& text) {
  return std::any_of(text.begin(), text.end(), is_control);
}

/// A word of bash, on one line whatever its text.
std::string shell_word(const std::string& text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./:=,%@";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  const bool escaped = has_control(text);
  std::string out = escaped ? "$'" : "'";
  for (const char c : text) {
    if (is_control(c)) {
      char code[16];
      std::snprintf(code, sizeof code, "\\x%02x", unsigned{static_cast<unsigned char>(c)});
      out += code;
    } else if (escaped && (c == '\'' || c == '\\')) {
      out += {'\\', c};
    } else {
      out += c == '\'' ? "'\\''" : std::string(1, c);
    }
  }
  return out + "'";
}

/// A path as a word that no program takes for an option.
std::string path_word(const std::string& path) {
  return shell_word(path.starts_with('-') ? "./" + path : path);
}

/// One word for sbatch --wrap: a command that sh, which has no $'...', hands to bash where needed.
std::string wrapped(const std::string& command) {
  return shell_word(command.find("$'") == std::string::npos ? command
                                                            : "bash -c " + shell_word(command));
}

/// A time in Slurm's form cannot be another directive. Throws InputError.
void check_time(const std::string& time) {
  if (!time.empty() && time.find_first_not_of("0123456789:-") == std::string::npos) return;
  throw InputError("lilytank study slurm: --time " + time +
                   " is not of Slurm's form, as 04:00:00 or 1-12");
}

}  // namespace

std::string slurm_script(const SlurmJob& job) {
  check_time(job.time);
  const std::string program = path_word(job.program), out = path_word(job.out);
  const std::string name = file_name_of(job.name, "study").substr(0, kLongestName);
  std::string command = program + " study " + path_word(job.study) + " --out " + out;
  for (const std::string& set : job.sets) command += " --set " + shell_word(set);
  std::string s = "#!/bin/bash\n";
  s += "# Study " + shell_word(job.name) + " in " + std::to_string(job.shards) +
       " shards, for Slurm. Save as study.sbatch, edit the lines #SBATCH for the site,\n"
       "# and submit, with the merging after it:\n"
       "#   job=$(sbatch --parsable study.sbatch)\n"
       "#   sbatch --dependency=afterok:$job --kill-on-invalid-dep=yes --job-name=merge --wrap " +
       wrapped(program + " study merge " + out + " && " + program + " study report " + out) +
       "\n"
       "# The tasks share the directory " +
       out +
       ". Whatever ends a task, submitting again\n"
       "# does only what is missing, with any number of shards.\n";
  s += "#SBATCH --job-name=" + name + "\n";
  s += "#SBATCH --array=0-" + std::to_string(job.shards - 1) + "\n";
  s += "#SBATCH --ntasks=1\n";
  s += "#SBATCH --cpus-per-task=" + std::to_string(job.cpus) + "\n";
  s += "#SBATCH --time=" + job.time + "\n";
  s += "#SBATCH --requeue\n"
       "#SBATCH --open-mode=append\n"
       "#SBATCH --signal=TERM@60\n"
       "#SBATCH --output=" +
       name + "-%A_%a.log\n\n";
  s += "# TERM, a minute before the time limit, makes the program keep what is finished and end "
       "with 3.\n"
       "export SLURM_EXIT_ERROR=125  # of srun itself; it would be 1, as for diverged simulations\n"
       "srun --cpus-per-task=\"$SLURM_CPUS_PER_TASK\" \\\n  " +
       command +
       " --threads \"$SLURM_CPUS_PER_TASK\"\n"
       "code=$?\n"
       "if [ \"$code\" -eq 3 ] && [ \"$(squeue -h -j \"$SLURM_JOB_ID\" -o %T)\" = RUNNING ]; then\n"
       "  # Simulations remain and the task was not cancelled: requeue it.\n"
       "  exec scontrol requeue \"$SLURM_JOB_ID\"\n"
       "fi\n"
       "# 1: some simulations diverged. Their rows are stored, and the study continues.\n"
       "[ \"$code\" -eq 1 ] && code=0\n"
       "exit \"$code\"\n";
  return s;
}

}  // namespace lilytank
