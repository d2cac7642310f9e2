// Connects the controls of the page with the module: all decisions are made there.
"use strict";

const $ = (id) => document.getElementById(id);
const number = (value, digits = 0) => value.toLocaleString("en", { minimumFractionDigits: digits, maximumFractionDigits: digits });
const element = (name, attributes = {}, ...children) => {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...children);
  return made;
};

// A message is the length of a text, the text of a JSON object, and bytes; see `message.rs`.
const packed = (object, parts) => {
  const text = new TextEncoder().encode(JSON.stringify(object));
  const message = new Uint8Array(4 + text.length + parts.reduce((sum, part) => sum + part.length, 0));
  new DataView(message.buffer).setUint32(0, text.length, true);
  let end = 4;
  for (const part of [text, ...parts]) {
    message.set(part, end);
    end += part.length;
  }
  return message;
};

const unpacked = (message) => {
  const end = 4 + new DataView(message.buffer).getUint32(0, true);
  return [JSON.parse(new TextDecoder().decode(message.subarray(4, end))), message.subarray(end)];
};

// A module that works beside the page. It answers one request after the other.
class Desk {
  #worker = new Worker(URL.createObjectURL(new Blob([$("worker").textContent], { type: "text/javascript" })));
  #waiting = [];
  #opened;

  constructor(module) {
    this.#worker.postMessage({ module });
    this.#worker.onmessage = ({ data }) => this.#waiting.shift()(data);
  }

  async #send(message) {
    const answered = new Promise((resolve) => this.#waiting.push(resolve));
    this.#worker.postMessage({ message });
    const { message: answer, hasEnded } = await answered;
    // What was open is gone after a panic, and is opened again.
    if (hasEnded && this.#opened && this.#opened !== message) await this.#send(this.#opened);
    return unpacked(answer);
  }

  async ask(object, parts = []) {
    const message = packed(object, parts);
    const [answer, bytes] = await this.#send(message);
    if (answer.error) throw new Error(answer.error);
    if (object.ask === "open") this.#opened = message;
    return [answer, bytes];
  }
}

// The bytes that are in the text of the page.
const bytesOf = (id) => Uint8Array.from(atob($(id).textContent), (c) => c.charCodeAt(0));

// The module, which another one unpacks.
const compiled = async () => {
  const packed = bytesOf("module"), length = Number($("module").dataset.length);
  const unpacker = new Blob([bytesOf("unpacker")]).stream().pipeThrough(new DecompressionStream("gzip"));
  const { memory, place, unpack } = (await WebAssembly.instantiate(await new Response(unpacker).arrayBuffer())).instance.exports;
  // A place may be beyond the memory that was there before.
  const packedAddress = place(packed.length);
  new Uint8Array(memory.buffer, packedAddress, packed.length).set(packed);
  const address = unpack(length);
  if (!address) throw new Error("The page is damaged: build it again.");
  return WebAssembly.compile(new Uint8Array(memory.buffer, address, length));
};

let catalogue, artist, surveyor, module, opened;
let turn = [0, 0];
// The request by which the scene was opened, for the surveyor and for other ways of reading it.
let source = { scene: "teapot", files: [], parts: [] };

const complain = (error) => {
  $("alert").textContent = error.message;
  $("alert").hidden = false;
};

const view = () => document.querySelector("input[name=view]:checked").value;

// What the controls say, as `choices.rs` reads it.
const choices = () => ({
  method: $("method").value || null,
  budget: $("budget").disabled || !$("budget").value ? null : Number($("budget").value),
  format: $("format").value,
  size: [$("width"), $("height")].map((side) => Math.min(1024, Math.max(1, Math.round(Number(side.value)) || 1))),
  frame: Number($("frame").value),
  turn,
  zoom: Number($("zoom").value),
  dither: $("dither").checked,
  antialias: $("antialias").checked,
  srgb: $("srgb").checked,
  material: $("surface").value && {
    colour: $("colour").value.slice(1),
    plastic: $("surface").value === "plastic",
    ...Object.fromEntries(["diffuse", "specular", "ambient", "exponent"].map((name) => [name, Number($(name).value)])),
  } || null,
  lights: $("lights").value && { kind: $("lights").value, azimuth: Number($("azimuth").value), elevation: Number($("elevation").value) } || null,
  background: $("has-background").checked ? $("background").value.slice(1) : null,
});

// Drawing: at most one picture is under way, and the next one shows the latest choices.
let isStale = false, isDrawing = false, quiet;

const redraw = () => {
  isStale = true;
  $("screen").setAttribute("aria-busy", true);
  clearTimeout(quiet);
  if (!isDrawing) requestAnimationFrame(draw);
};

const draw = async () => {
  if (isDrawing || !isStale || !opened) return;
  [isStale, isDrawing] = [false, true];
  try {
    const begin = performance.now();
    const [picture, rgba] = await artist.ask({ ask: "draw", choices: choices(), view: view() });
    show(picture, rgba, performance.now() - begin);
    $("alert").hidden = true;
  } catch (error) {
    complain(error);
  }
  isDrawing = false;
  if (isPlaying) advance();
  if (isStale) requestAnimationFrame(draw);
  else {
    $("screen").setAttribute("aria-busy", false);
    quiet = setTimeout(measure, 300);
  }
};

const show = ({ size: [width, height], crc, triangles, drawn, command, convert, needsStream }, rgba, time) => {
  const canvas = $("canvas");
  if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  // The processor writes each picture, and reads it again to save it, so the picture stays in its memory.
  canvas.getContext("2d", { willReadFrequently: true }).putImageData(new ImageData(new Uint8ClampedArray(rgba.buffer, rgba.byteOffset, rgba.length), width, height), 0, 0);
  fit();
  const isPicture = view() === "picture";
  $("size").textContent = `${width} × ${height}`;
  $("crc").textContent = isPicture ? crc : "–";
  $("triangles").textContent = `${number(drawn)} of ${number(triangles)}`;
  $("time").textContent = `${number(time, 1)} ms`;
  if (isPicture) {
    $("command").textContent = command;
    $("command-note").textContent =
      `${needsStream ? "Download the mesh file below. In" : "In"} a clone of the repository, this command draws the same picture and prints the same checksum:`;
    $("converting").hidden = !convert;
    $("convert").textContent = convert ?? "";
  }
  document.documentElement.dataset.pictures = Number(document.documentElement.dataset.pictures ?? 0) + 1;
  document.documentElement.dataset.first ??= performance.now();
};

// Shows each pixel of the picture as a square of whole pixels of this screen.
const fit = () => {
  const canvas = $("canvas"), ratio = devicePixelRatio || 1;
  const look = catalogue.panels[$("panel").value - 1]?.look ?? "lcd";
  // A narrow page keeps the picture in sight above the controls.
  const { paddingLeft, position } = getComputedStyle($("stage"));
  const frame = ["oled", "reflective"].includes(look) ? 20 : 0;
  const room = [$("stage").clientWidth - 2 * parseFloat(paddingLeft) - frame, Math.max(240, innerHeight * (position === "sticky" ? 0.4 : 0.62))];
  const factor = Math.max(1, Math.floor(Math.min(room[0] * ratio / canvas.width, room[1] * ratio / canvas.height))) / ratio;
  // A picture that is wider than the page is shown smaller, for it could not be seen otherwise.
  const shown = Math.min(factor, room[0] / canvas.width);
  [canvas.style.width, canvas.style.height] = [`${canvas.width * shown}px`, `${canvas.height * shown}px`];
  $("screen").className = view() === "picture" && shown * ratio >= 2 || look === "round" ? look : "lcd";
  $("screen").style.setProperty("--factor", `${shown}px`);
  $("screen").style.setProperty("--gap", `${Math.max(1, Math.round(shown * ratio / 5)) / ratio}px`);
};

// Measuring takes longer than drawing, so it waits until nothing moves, and another worker does it.
let measured = 0;
const measure = async () => {
  const mine = ++measured;
  $("status").textContent = "Measuring …";
  try {
    surveyor ??= new Desk(module);
    if (surveyor.source !== source) {
      surveyor.source = source;
      await surveyor.ask(request(), source.parts);
    }
    const [figures] = await surveyor.ask({ ask: "measure", choices: choices() });
    if (mine === measured) report(figures);
  } catch (error) {
    $("status").textContent = error.message;
  }
};

const swatch = (colour) => {
  const made = element("span", { className: "swatch" });
  made.style.background = `rgb(${colour})`;
  return made;
};

const report = ({ errors, ways, budget, layout, memory, features, boards }) => {
  const figure = (value, text) => element("span", {}, element("b", { textContent: value }), text);
  if (errors.Ok) {
    const { largest, most, mean } = errors.Ok;
    $("errors").replaceChildren(
      element("div", { className: "figures" }, figure(number(largest, 2), "largest"), figure(number(most, 2), "at most, in 99 of 100 pixels"),
        figure(number(mean, 3), "root mean square")),
      element("p", { className: "hint", textContent: `In 1/255 of full light, before the pixel format rounds it.${budget ? ` The budget is ${budget}.` : ""}` }));
  } else {
    $("errors").replaceChildren(element("p", { className: "hint", textContent: errors.Err }));
  }
  $("ways-card").hidden = !ways;
  if (ways) {
    const all = ways.reduce((sum, way) => sum + way.pixels, 0) || 1;
    const bar = element("div", { className: "bar" });
    bar.setAttribute("aria-hidden", "true");
    for (const { colour, pixels } of ways) {
      const part = element("span");
      part.style.cssText = `background: rgb(${colour}); flex: ${pixels}`;
      bar.append(part);
    }
    $("ways").replaceChildren(bar, table(["Way of shading", "Triangles", "Pixels", "Share"],
      ways.map(({ name, colour, triangles, pixels }) => [[swatch(colour), name], number(triangles), number(pixels), `${number(100 * pixels / all, 1)} %`])));
  }
  $("boards").replaceChildren(
    table(["Chip", "Instructions", "Frames a second", "Flash", "RAM"], boards.rows.map((row) => [
      row.title, row.instructions ? `${number(row.instructions / 1000)} k` : "not counted", row.rate ? number(row.rate, row.rate < 10 ? 1 : 0) : "–",
      part(row.flash, row.flashRoom), part(row.ram, row.ramRoom)])),
    element("p", { className: "hint", textContent: boards.note }));
  $("layout").textContent = layout;
  $("memory").textContent = `The renderer takes ${number(memory[0])} bytes of RAM, and a band of pixels ${number(memory[1])} bytes. ` +
    (features.length ? `The least program has the cargo features ${features.join(", ")}.` : "The least program needs no cargo features.");
  const error = errors.Ok ? `The largest error is ${number(errors.Ok.largest, 2)} of 255. ` : "";
  $("status").textContent = `${error}Checksum ${$("crc").textContent}.`;
  document.documentElement.dataset.measured = Number(document.documentElement.dataset.measured ?? 0) + 1;
};

// What a part takes of a chip.
const part = (bytes, room) => {
  const made = element("span", { textContent: `${number(bytes / 1024)} of ${number(room / 1024)} KB` });
  if (bytes > room) {
    made.className = "full";
    made.textContent += ", too much";
  }
  return made;
};

const table = (heads, rows) => {
  const head = element("thead", {}, element("tr", {}, ...heads.map((text) => element("th", { scope: "col", textContent: text }))));
  const body = element("tbody", {}, ...rows.map((cells) => element("tr", {}, ...cells.map((cell) => element("td", {}, ...[cell].flat())))));
  const made = element("div", { className: "scroll", tabIndex: 0 }, element("table", {}, head, body));
  made.setAttribute("role", "region");
  made.setAttribute("aria-label", `Table: ${heads.join(", ")}`);
  return made;
};

// Opening: a built-in scene, or files.
const request = () => ({
  ask: "open",
  scene: source.scene,
  files: source.files,
  reading: { up: $("up").value === "y" ? null : $("up").value, flip: $("flip").checked, simplify: Number($("simplify").value) || null },
});

const open = async (wanted) => {
  const before = source;
  source = { ...wanted };
  $("status").textContent = "Reading …";
  $("screen").setAttribute("aria-busy", true);
  try {
    [opened] = await artist.ask(request(), source.parts);
  } catch (error) {
    // What was open stays open.
    source = before;
    $("status").textContent = "";
    $("screen").setAttribute("aria-busy", false);
    complain(error);
    return;
  }
  $("alert").hidden = true;
  if (!source.scene) $("scene").value = "";
  $("reading").hidden = Boolean(source.scene);
  $("remarks").replaceChildren(...opened.remarks.map((remark) => element("li", { textContent: remark })));
  $("frame").max = Math.max(0, opened.frames - 1);
  $("frame").value = 0;
  $("antialias").disabled = !opened.hasSmoothOutlines;
  $("method").options[0].textContent = `as the scene says: ${opened.method}`;
  [turn, $("zoom").value] = [[0, 0], 1];
  if (!$("panel").value) resize(opened.size);
  $("screen").setAttribute("aria-label", `Picture of ${opened.name}, ${opened.triangles} triangles`);
  update();
};

const resize = ([width, height]) => {
  $("width").value = width;
  $("height").value = height;
};

// What belongs together is shown together.
const update = () => {
  const shader = catalogue.methods.find(({ name }) => name === ($("method").value || opened?.method));
  $("budget").disabled = !shader?.has_budget;
  const ways = document.querySelector("input[value=ways]");
  ways.disabled = !shader?.has_budget;
  if (ways.disabled && ways.checked) document.querySelector("input[value=picture]").checked = true;
  $("dither").disabled = !catalogue.formats.find(({ name }) => name === $("format").value).is_dithered;
  $("material").hidden = !$("surface").value;
  $("light").hidden = !$("lights").value;
  $("background-label").hidden = !$("has-background").checked;
  for (const output of document.querySelectorAll("output")) output.textContent = Math.round(100 * $(output.htmlFor.value).value) / 100;
  $("legend").hidden = view() === "picture";
  $("legend").replaceChildren(...(view() === "ways"
    ? catalogue.ways.map(({ name, colour }) => element("span", {}, swatch(colour), name))
    : catalogue.errors.map(([error, colour], index, { length }) =>
        element("span", {}, swatch(colour), index + 1 === length ? `${error} or more, of 255` : String(error)))));
  redraw();
};

// Files that were dropped, with those of dropped folders, by their paths.
const dropped = async ({ items, files }) => {
  const entries = [...items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (!entries.some((entry) => entry.isDirectory)) return [...files].map((file) => [file.name, file]);
  const found = [];
  const walk = async (entry, place) => {
    if (entry.isFile) {
      found.push([place + entry.name, await new Promise((resolve, reject) => entry.file(resolve, reject))]);
      return;
    }
    const reader = entry.createReader();
    // A reader returns some entries at a time.
    for (let some; (some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject))).length;) {
      for (const inner of some) await walk(inner, `${place}${entry.name}/`);
    }
  };
  for (const entry of entries) await walk(entry, "");
  return found;
};

const openFiles = async (named) => {
  if (!named.length) return;
  try {
    const parts = await Promise.all(named.map(async ([, file]) => new Uint8Array(await file.arrayBuffer())));
    await open({ scene: null, files: named.map(([name], index) => ({ name, length: parts[index].length })), parts });
  } catch (error) {
    complain(error);
  }
};

const take = async (what) => {
  try {
    const [{ name }, bytes] = await artist.ask({ ask: "take", what, choices: choices() });
    const link = element("a", { href: URL.createObjectURL(new Blob([bytes])), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  } catch (error) {
    complain(error);
  }
};

let isPlaying = false;
const advance = () => {
  $("frame").value = (Number($("frame").value) + 1) % (Number($("frame").max) + 1);
  document.querySelector("output[for=frame]").textContent = $("frame").value;
  isStale = true;
};

const turnBy = (right, towards) => {
  turn = [(turn[0] + right) % 360, Math.max(-180, Math.min(180, turn[1] + towards))];
  redraw();
};

const zoomTo = (zoom) => {
  $("zoom").value = zoom;
  update();
};

const resetView = () => {
  turn = [0, 0];
  zoomTo(1);
};

const listen = () => {
  $("controls").addEventListener("submit", (event) => event.preventDefault());
  $("controls").addEventListener("input", ({ target }) => {
    if (target.id === "scene") {
      if (target.value) open({ scene: target.value, files: [], parts: [] });
    } else if (["up", "flip", "simplify"].includes(target.id)) {
      // A number that is being written is read when it is complete.
      if (target.id !== "simplify") open(source);
    } else if (target.id === "panel") {
      const panel = catalogue.panels[target.value - 1];
      resize(panel?.size ?? opened.size);
      $("format").value = panel?.format ?? "rgb565";
      update();
    } else if (target.id !== "files") {
      update();
    }
  });
  $("simplify").addEventListener("change", () => open(source));
  for (const radio of document.querySelectorAll("input[name=view]")) radio.addEventListener("change", update);
  $("choose").addEventListener("click", () => $("files").click());
  $("files").addEventListener("change", () => openFiles([...$("files").files].map((file) => [file.name, file])));
  $("take-stream").addEventListener("click", () => take("stream"));
  $("take-program").addEventListener("click", () => take("program"));
  for (const button of document.querySelectorAll("[data-copy]")) {
    button.setAttribute("aria-label", `Copy: ${$(button.dataset.copy).getAttribute("aria-label").toLowerCase()}`);
    button.addEventListener("click", async () => {
      await navigator.clipboard.writeText($(button.dataset.copy).textContent);
      $("status").textContent = "Copied.";
    });
  }
  $("play").addEventListener("click", () => {
    isPlaying = !isPlaying;
    $("play").setAttribute("aria-pressed", isPlaying);
    if (isPlaying) {
      advance();
      redraw();
    }
  });
  $("turn-back").addEventListener("click", resetView);

  const screen = $("screen");
  const zoomBy = (factor) => zoomTo(Number($("zoom").value) * factor);
  const keys = {
    ArrowLeft: () => turnBy(-5, 0), ArrowRight: () => turnBy(5, 0), ArrowUp: () => turnBy(0, -5), ArrowDown: () => turnBy(0, 5),
    "+": () => zoomBy(1.25), "-": () => zoomBy(0.8), Home: resetView,
  };
  screen.addEventListener("keydown", (event) => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
  });
  // The pointers that are down, by their numbers. One turns, and two zoom as they part.
  const down = new Map();
  const span = () => {
    const [[x, y], [otherX, otherY]] = down.values();
    return Math.max(1, Math.hypot(x - otherX, y - otherY));
  };
  screen.addEventListener("pointerdown", ({ pointerId, button, clientX, clientY }) => {
    if (button) return;
    screen.setPointerCapture(pointerId);
    screen.focus({ focusVisible: false });
    down.set(pointerId, [clientX, clientY]);
  });
  screen.addEventListener("pointermove", ({ pointerId, clientX, clientY }) => {
    if (!down.has(pointerId)) return;
    const [x, y] = down.get(pointerId), before = down.size === 2 && span();
    down.set(pointerId, [clientX, clientY]);
    if (before) zoomBy(span() / before);
    else if (down.size === 1) turnBy(0.6 * (clientX - x), 0.6 * (clientY - y));
  });
  for (const end of ["pointerup", "pointercancel"]) screen.addEventListener(end, ({ pointerId }) => down.delete(pointerId));
  // Browsers report a pinch on a touch pad as a wheel with the control key.
  screen.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoomBy(Math.exp(-0.01 * event.deltaY));
  }, { passive: false });

  addEventListener("dragover", (event) => {
    event.preventDefault();
    $("drop").hidden = false;
  });
  addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) $("drop").hidden = true;
  });
  addEventListener("drop", async (event) => {
    event.preventDefault();
    $("drop").hidden = true;
    openFiles(await dropped(event.dataTransfer));
  });
  addEventListener("resize", () => opened && fit());
};

const options = (id, entries) =>
  $(id).replaceChildren(...entries.map(([value, textContent, disabled = false]) => element("option", { value, textContent, disabled })));

const begin = async () => {
  module = await compiled();
  artist = new Desk(module);
  [catalogue] = await artist.ask({ ask: "catalogue" });
  options("scene", [["", "files of your own", true], ...catalogue.scenes.map(({ name, title }) => [name, `${name}: ${title}`])]);
  options("method", [["", "as the scene says"], ...catalogue.methods.map(({ name, title }) => [name, title])]);
  options("budget", [["", "as the pixel format decides"], ...catalogue.budgets.map((budget) => [budget, `${budget} of 255`])]);
  options("panel", [["", "the size of the scene"], ...catalogue.panels.map(({ name, size }, index) => [index + 1, `${name}, ${size.join(" × ")}`])]);
  options("format", catalogue.formats.map(({ name, title }) => [name, title]));
  options("up", catalogue.ups.map((name) => [name, name]));
  $("up").value = "y";
  $("scene").value = source.scene;
  // The first picture is that of a common display.
  $("panel").value = 1;
  resize(catalogue.panels[0].size);
  $("colour").value = `#${catalogue.material.colour}`;
  for (const name of ["diffuse", "specular", "ambient", "exponent"]) $(name).value = catalogue.material[name];
  listen();
  await open(source);
};

begin().catch(complain);
