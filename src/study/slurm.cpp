// A batch script for Slurm.
#include "lilytank/study.hpp"

namespace lilytank {
namespace {

/// A word for a POSIX shell.
std::string shell_word(const std::string& text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./:=,%@";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string slurm_script(const SlurmJob& job) {
  const std::string program = shell_word(job.program), out = shell_word(job.out);
  std::string command = program + " study " + shell_word(job.study) + " --out " + out;
  for (const std::string& set : job.sets) command += " --set " + shell_word(set);
  std::string s = "#!/bin/bash\n";
  s += "# Study '" + job.name + "' in " + std::to_string(job.shards) +
       " shards, for Slurm. Save as study.sbatch, edit the lines #SBATCH for the site,\n"
       "# and submit, with the merging after it:\n"
       "#   job=$(sbatch --parsable study.sbatch)\n"
       "#   sbatch --dependency=afterok:$job --kill-on-invalid-dep=yes --job-name=merge --wrap " +
       shell_word(program + " study merge " + out + " && " + program + " study report " + out) +
       "\n"
       "# The tasks share the directory " +
       job.out +
       ". Whatever ends a task, submitting again\n"
       "# does only what is missing, with any number of shards.\n";
  s += "#SBATCH --job-name=" + job.name + "\n";
  s += "#SBATCH --array=0-" + std::to_string(job.shards - 1) + "\n";
  s += "#SBATCH --ntasks=1\n";
  s += "#SBATCH --cpus-per-task=" + std::to_string(job.cpus) + "\n";
  s += "#SBATCH --time=" + job.time + "\n";
  s += "#SBATCH --requeue\n"
       "#SBATCH --open-mode=append\n"
       "#SBATCH --signal=TERM@60\n"
       "#SBATCH --output=" +
       job.name + "-%A_%a.log\n\n";
  s += "# TERM, a minute before the time limit, makes the program keep what is finished and end "
       "with 3.\n"
       "export SLURM_EXIT_ERROR=125  # of srun itself; it would be 1, as of diverged worlds\n"
       "srun --cpus-per-task=\"$SLURM_CPUS_PER_TASK\" \\\n  " +
       command +
       " --threads \"$SLURM_CPUS_PER_TASK\"\n"
       "code=$?\n"
       "if [ \"$code\" -eq 3 ] && [ \"$(squeue -h -j \"$SLURM_JOB_ID\" -o %T)\" = RUNNING ]; then\n"
       "  # There is more to do, and nobody has cancelled the task: take it up again.\n"
       "  exec scontrol requeue \"$SLURM_JOB_ID\"\n"
       "fi\n"
       "# 1 says that worlds diverged: their rows are there, and the study goes on.\n"
       "[ \"$code\" -eq 1 ] && code=0\n"
       "exit \"$code\"\n";
  return s;
}

}  // namespace lilytank
