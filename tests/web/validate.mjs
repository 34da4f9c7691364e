// Prints what the Khronos validator says of each file named: one JSON object, from file name to its report.
import { readFile } from 'node:fs/promises';
import { basename } from 'node:path';
import { validateBytes } from 'gltf-validator';

const reports = {};
for (const file of process.argv.slice(2)) {
  const { issues, info } = await validateBytes(await readFile(file), { format: 'glb', maxIssues: 100 });
  const messages = issues.messages.map(({ code, message, severity, pointer }) => ({ code, message, severity, pointer }));
  reports[basename(file)] = {
    errors: issues.numErrors,
    warnings: issues.numWarnings,
    messages,
    vertices: info.totalVertexCount,
    triangles: info.totalTriangleCount,
  };
}
console.log(JSON.stringify(reports));
