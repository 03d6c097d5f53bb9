//! A script that runs a sweep as an array of tasks of Slurm.

use super::manifest::Manifest;
use std::path::Path;

/// The most tasks of an array: what Slurm admits unless its administrator says otherwise.
const MOST_TASKS: usize = 1000;

/// The script, for the runs that are missing in a folder. Each task runs one row, or several of a large sweep.
pub fn script(folder: &Path, manifest: &Manifest) -> String {
    let count = manifest.rows.len();
    let each = count.div_ceil(MOST_TASKS).max(1);
    let tasks = count.div_ceil(each);
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_path_buf());
    let folder = folder.display().to_string().replace('\'', "'\\''");
    let run = "signorini sweep \"$sweep\" --threads \"${SLURM_CPUS_PER_TASK:-1}\" --task";
    let body = match each {
        1 => format!("{run} \"$SLURM_ARRAY_TASK_ID\"\n"),
        each => format!(
            "first=$(( (SLURM_ARRAY_TASK_ID - 1) * {each} + 1 ))\nlast=$(( SLURM_ARRAY_TASK_ID * {each} ))\n\
             if [ \"$last\" -gt {count} ]; then last={count}; fi\n\
             worst=0\nfor row in $(seq \"$first\" \"$last\"); do\n  {run} \"$row\" || worst=$?\ndone\nexit $worst\n"
        ),
    };
    format!(
        "#!/bin/sh\n#SBATCH --job-name=signorini-sweep\n#SBATCH --array=1-{tasks}\n#SBATCH --ntasks=1\n\
         #SBATCH --cpus-per-task=1\n#SBATCH --time=01:00:00\n#SBATCH --mem=2G\n\
         # {count} runs. Adapt time, memory and partition, then submit:  sbatch sweep.slurm\n\
         # A run that has ended is not run again. When all have ended:  signorini sweep FOLDER --gather\n\
         sweep='{folder}'\n{body}"
    )
}
