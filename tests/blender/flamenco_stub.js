// What Flamenco's manager offers a job compiler script, as its documentation, its built-in scripts, and its
// source have it: flamenco.blender.org/usage/job-types and …/jobs-tasks-commands/commands. All else throws.
// node flamenco_stub.js SCRIPT SETTINGS: prints the job type and the tasks of a job as JSON.
"use strict";
const fs = require("fs");
const vm = require("vm");

const PARAMETERS = { "exec": { exe: "string", args: "object" } };

function author() {
    return {
        Task(name, type) {
            if (!name.trim() || !type.trim()) throw new Error("a task has a name and a type");
            const task = { name, type, commands: [], dependencies: [] };
            Object.defineProperty(task, "addCommand", { value: command => { task.commands.push(command); } });
            Object.defineProperty(task, "addDependency", { value: other => { task.dependencies.push(other.name); } });
            return task;
        },
        Command(name, parameters) {
            const known = PARAMETERS[name];
            if (!known) throw new Error(`no command ${name}`);
            for (const key of Object.keys(known)) {
                if (typeof parameters[key] !== known[key]) throw new Error(`${name}: ${key} is missing`);
            }
            for (const key of Object.keys(parameters)) {
                if (!known[key]) throw new Error(`${name} has no ${key}`);
            }
            return { name, parameters };
        },
    };
}

const path = {
    basename: name => name.split(/[\\/]/).pop(),
    stem: name => name.replace(/\.[^./]*$/, ""),
};

// Quotes and blanks of a shell; the real one is the package shlex.
function shellSplit(text) {
    return (text.match(/"[^"]*"|'[^']*'|[^\s"']+/g) || []).map(word => word.replace(/^["']|["']$/g, ""));
}

const tasks = [];
const context = vm.createContext({ author: author(), path, shellSplit, print() {} });
vm.runInContext(`"use strict";\n${fs.readFileSync(process.argv[2], "utf-8")}\nthis.JOB_TYPE = JOB_TYPE;
this.compileJob = compileJob;`, context);
const settings = JSON.parse(process.argv[3]);
context.compileJob({ settings, addTask: task => { tasks.push(task); } });
console.log(JSON.stringify({ type: context.JOB_TYPE, tasks }));
