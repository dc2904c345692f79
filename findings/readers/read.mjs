// read.mjs READER FILE -- as read.py, with h5wasm or jsfive, in whose folder it is to be.
import fs from 'node:fs';
const [reader, name] = process.argv.slice(2);
let file;
if (reader === 'h5wasm') {
  const { default: h5wasm } = await import('h5wasm/node');
  await h5wasm.ready;
  file = new h5wasm.File(name, 'r');
} else {
  const jsfive = await import('jsfive');
  const bytes = fs.readFileSync(name);
  const own = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  file = new (jsfive.File ?? jsfive.default.File)(own, name);
}
const keys = typeof file.keys === 'function' ? file.keys() : file.keys;
for (const key of keys) {
  try {
    const value = file.get(key).value;
    if (value === undefined) continue; // a group
    const numbers = value.length === undefined ? [value] : Array.from(value);
    console.log(key + '\t' + numbers.map(Number).join(' '));
  } catch (error) {
    console.log(key + '\t!' + String(error).split('\n')[0]);
  }
}
