// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job type of Flamenco, Blender's render farm: the tools of Ridgeform on many files. Put this file into the
// folder `scripts` beside `flamenco-manager`; docs/manual.md says more.

const JOB_TYPE = {
    label: "Ridgeform",
    settings: [
        { key: "input_folder", type: "string", subtype: "dir_path", required: true, visible: "submission",
          description: "Folder with the files to read, on a disk that all workers see" },
        { key: "pattern", type: "string", required: true, default: "*.ply", visible: "submission",
          description: "Which files of the folder are read" },
        { key: "output_folder", type: "string", subtype: "dir_path", required: true,
          description: "Folder to write to, on a disk that all workers see" },
        { key: "arguments", type: "string", required: true, default: "stylize",
          description: "A tool with its options, as on the command line, or: run /shared/recipe.toml" },
        { key: "chunk_size", type: "int32", required: true, default: 10, propargs: { min: 1 },
          visible: "submission", description: "Files in one task" },

        // Found when the job is submitted: the script itself sees no disk, and knows no folder of a blend file.
        { key: "files", type: "string", required: true, editable: false, visible: "web",
          eval: "__import__('json').dumps(sorted(p.as_posix() for p in " +
              "abspath(settings.input_folder).glob(settings.pattern) if p.is_file()))",
          description: "Paths of the files, as a list in JSON" },
        { key: "output", type: "string", required: true, editable: false, visible: "web",
          eval: "abspath(settings.output_folder).as_posix()",
          description: "Path of the folder to write to" },
    ],
};

// Options that this script sets itself, or that would have every task start others.
const OWN_OPTIONS = ["-o", "--output", "--resume", "--jobs", "--memory", "--dask", "--report", "--pictures",
    "--json"];

function compileJob(job) {
    const settings = job.settings;
    const args = shellSplit(settings.arguments);
    if (args.length === 0) {
        throw "Arguments: write a tool, such as: stylize --strength 0.6";
    }
    for (const arg of args) {
        const option = arg.split("=")[0];
        if (OWN_OPTIONS.indexOf(option) >= 0) {
            throw `Arguments: leave ${option} to this job type`;
        }
    }
    const files = JSON.parse(settings.files);
    if (files.length === 0) {
        throw `There is no file ${settings.pattern} in ${settings.input_folder}`;
    }
    const names = files.map(file => path.basename(file));
    refuseEqualOutputs(names, args.some(arg => arg.split("=")[0] === "--format"));

    const size = Math.max(1, settings.chunk_size);
    const tasks = [];
    for (let begin = 0; begin < files.length; begin += size) {
        const end = Math.min(begin + size, files.length);
        const task = author.Task(`files-${begin + 1}-${end}`, "blender");
        task.addCommand(ridgeform(settings, args, files.slice(begin, end), ["--pictures"]));
        tasks.push(task);
    }
    const summary = author.Task("summary", "blender");
    const page = settings.output.replace(/[\\/]+$/, "") + ".html";
    // All is done by then, so that only the page is made.
    summary.addCommand(ridgeform(settings, args, files, ["--report", page]));
    for (const task of tasks) {
        job.addTask(task);
        summary.addDependency(task);
    }
    job.addTask(summary);
}

// A task that is tried again, on whatever worker, does only what is left: the journal beside the output knows.
// The slash has the output taken as a folder whatever its name ends in.
function ridgeform(settings, args, files, more) {
    const output = settings.output.replace(/[\\/]+$/, "") + "/";
    const all = ["--command", "ridgeform"].concat(args, more, ["--resume", "-o", output]);
    return author.Command("exec", { exe: "{blender}", args: all.concat(["--"], files) });
}

// Each task sees its own files only, so two of them could have the same output.
function refuseEqualOutputs(names, oneFormat) {
    const seen = {};
    for (const name of names) {
        const output = (oneFormat ? path.stem(name) : name).toLowerCase();
        if (seen[output]) {
            throw `${seen[output]} and ${name} would have the same output: put them into different folders`;
        }
        seen[output] = name;
    }
}
