// Runs the module beside the page, so that the page always answers. A message goes in, and a message comes out; see `message.rs`.
"use strict";

let module, instance;

const start = () => {
  instance = new WebAssembly.Instance(module, {});
};

// The message at a place: four bytes before it are its length.
const at = (address) => {
  const { buffer } = instance.exports.memory;
  const length = new DataView(buffer).getUint32(address >>> 0, true);
  return new Uint8Array(buffer, (address >>> 0) + 4, length).slice();
};

const ask = (message) => {
  const { memory, place, answer } = instance.exports;
  const address = place(message.length) >>> 0;
  new Uint8Array(memory.buffer, address, message.length).set(message);
  return at(answer());
};

onmessage = ({ data }) => {
  if (data.module) {
    module = data.module;
    start();
    return;
  }
  let message, hasEnded = false;
  try {
    message = ask(data.message);
  } catch {
    // A panic ends the module. What it had open is gone.
    message = at(instance.exports.fault());
    start();
    hasEnded = true;
  }
  postMessage({ message, hasEnded }, [message.buffer]);
};
