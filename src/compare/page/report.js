"use strict";
// Draws the page's images from their float data. `show` is the whole state; `redraw` paints what it says.

const data = JSON.parse(document.getElementById("data").textContent);
const { width, height } = data;
const element = (id) => document.getElementById(id);
const modes = [
  { name: "swipe", label: "Swipe" }, { name: "flicker", label: "Flicker" }, { name: "a", label: data.names.a },
  { name: "b", label: data.names.b }, { name: "difference", label: "Difference" },
  { name: "error", label: "Relative error" },
];
const show = {
  mode: "swipe", layer: 0, exposure: data.exposure, tone: "clip", divider: 0.5, flickerA: true,
  zoom: 1, panX: 0, panY: 0,  // device pixels per image pixel, and where the image's corner lies
  range: 1,                   // the difference map spans [-range, range]
  pixel: [Math.floor(width / 2), Math.floor(height / 2)],
};
let layers = [];    // [{name, a, b, difference: Float32Array}], r,g,b per pixel; NaN where not finite
let pictures = {};  // canvases of image size by name, painted when first needed, dropped when their settings change

// ---------------------------------------------------------------------------------------------- reading the data

/** Rows of an 8-bit RGB PNG. Its bytes are read here because a browser may change them by colour management. */
async function readPng(base64) {
  const file = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const view = new DataView(file.buffer);
  const idat = [];
  let columns = 0, rows = 0;
  for (let at = 8; at < file.length;) {
    const length = view.getUint32(at), type = String.fromCharCode(...file.subarray(at + 4, at + 8));
    if (type === "IHDR") [columns, rows] = [view.getUint32(at + 8), view.getUint32(at + 12)];
    if (type === "IDAT") idat.push(file.subarray(at + 8, at + 8 + length));
    at += length + 12;
  }
  const inflated = new Blob(idat).stream().pipeThrough(new DecompressionStream("deflate"));
  return unfilter(new Uint8Array(await new Response(inflated).arrayBuffer()), 3 * columns, rows);
}

/** Undoes the filters of the PNG specification, section 9. */
function unfilter(filtered, stride, rows) {
  const bytes = new Uint8Array(stride * rows), pixel = 3;
  for (let y = 0; y < rows; ++y) {
    const filter = filtered[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const at = y * stride + x;
      const left = x >= pixel ? bytes[at - pixel] : 0, up = y > 0 ? bytes[at - stride] : 0;
      const corner = x >= pixel && y > 0 ? bytes[at - stride - pixel] : 0;
      const guess = filter === 4 ? paeth(left, up, corner) : [0, left, up, (left + up) >> 1][filter];
      bytes[at] = filtered[at + y + 1] + guess;
    }
  }
  return bytes;
}

function paeth(left, up, corner) {
  const estimate = left + up - corner;
  const a = Math.abs(estimate - left), b = Math.abs(estimate - up), c = Math.abs(estimate - corner);
  return a <= b && a <= c ? left : b <= c ? up : corner;
}

/** Floats from mantissas and, in the rows below them, the exponents they share (Ward 1991). */
function decode(bytes, bits, signed) {
  const rgb = new Float32Array(3 * width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const exponent = bytes[3 * ((height + Math.floor(y / 3)) * width + x) + (y % 3)];
      const scale = exponent === 255 ? NaN : 2 ** (exponent - 128 - bits), zero = signed ? 128 : 0;
      for (let c = 0; c < 3; ++c) rgb[3 * (y * width + x) + c] = (bytes[3 * (y * width + x) + c] - zero) * scale;
    }
  return rgb;
}

const leastFloat = 2 ** -126;
const luminance = (rgb, i) => 0.2126 * rgb[3 * i] + 0.7152 * rgb[3 * i + 1] + 0.0722 * rgb[3 * i + 2];

// ---------------------------------------------------------------------------------------------- painting pictures

const toneMaps = { clip: (v) => v, reinhard: (v) => v / (1 + Math.max(v, 0)) };

function encode(linear) {  // sRGB, 0 to 255
  const v = Math.min(Math.max(linear, 0), 1);
  return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
}

function mapColor(map, t) {
  if (!Number.isFinite(t)) return data.nonfinite_color;
  const position = Math.min(Math.max(t, 0), 1) * (map.length - 1);
  const below = Math.min(Math.floor(position), map.length - 2), fraction = position - below;
  return map[below].map((v, c) => v * (1 - fraction) + map[below + 1][c] * fraction);
}

function paint(colorOf) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [width, height];
  const context = canvas.getContext("2d"), image = context.createImageData(width, height);
  for (let i = 0; i < width * height; ++i) {
    const color = colorOf(i);
    for (let c = 0; c < 3; ++c) image.data[4 * i + c] = Math.round(color[c]);
    image.data[4 * i + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

function paintRadiance(rgb) {
  const scale = 2 ** show.exposure;
  return paint((i) => {
    const pixel = [rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]];
    return pixel.some(Number.isNaN) ? data.nonfinite_color : pixel.map((v) => encode(toneMaps[show.tone](v * scale)));
  });
}

function picture(name) {
  const { a, b, difference } = layers[show.layer];
  pictures[name] ??= {
    a: () => paintRadiance(a),
    b: () => paintRadiance(b),
    difference: () => paint((i) =>
      mapColor(data.cool_warm, 0.5 + (0.5 * luminance(difference, i)) / show.range)),
    error: () => {
      const floor = Math.max(0.01 * meanLuminance(b), leastFloat);  // so that 0 / floor exists where all is black
      return paint((i) => mapColor(data.inferno,
        Math.abs(luminance(difference, i)) / Math.max(luminance(b, i), floor)));
    },
  }[name]();
  return pictures[name];
}

function meanLuminance(rgb) {
  let sum = 0;
  for (let i = 0; i < width * height; ++i) sum += luminance(rgb, i) || 0;
  return sum / (width * height);
}

/** 1, 2 or 5 times a power of ten, the least that is not below the value. */
function roundUp(value) {
  const decade = 10 ** Math.floor(Math.log10(value));
  return decade * ([1, 2, 5].find((step) => value <= step * decade * (1 + 1e-6)) ?? 10);
}

/** The 95th percentile of the absolute difference, rounded up. */
function automaticRange() {
  const { difference } = layers[show.layer], values = [];
  for (let i = 0; i < width * height; ++i) {
    const value = Math.abs(luminance(difference, i));
    if (Number.isFinite(value)) values.push(value);
  }
  values.sort((a, b) => a - b);
  const percentile = values[Math.floor(0.95 * (values.length - 1))];
  return percentile > 0 ? roundUp(percentile) : 1;
}

// ---------------------------------------------------------------------------------------------- showing them

const canvas = element("canvas"), context = canvas.getContext("2d");
const ratio = () => window.devicePixelRatio || 1;

function fit() {
  const stage = element("stage");
  canvas.style.height = Math.round(Math.min(0.72 * window.innerHeight, (stage.clientWidth * height) / width)) + "px";
  canvas.width = Math.round(stage.clientWidth * ratio());
  canvas.height = Math.round(parseFloat(canvas.style.height) * ratio());
  setZoom(Math.min(canvas.width / width, canvas.height / height));
  show.panX = (canvas.width - width * show.zoom) / 2;
  show.panY = (canvas.height - height * show.zoom) / 2;
  redraw();
}

/** Zooms about a place of the canvas, its middle unless told. */
function setZoom(zoom, x = canvas.width / 2, y = canvas.height / 2) {
  const clamped = Math.min(Math.max(zoom, 0.125), 128);
  show.panX = x - ((x - show.panX) * clamped) / show.zoom;
  show.panY = y - ((y - show.panY) * clamped) / show.zoom;
  show.zoom = clamped;
}

function drawPicture(name, clipLeft, clipRight) {
  context.save();
  context.beginPath();
  context.rect(clipLeft, 0, clipRight - clipLeft, canvas.height);
  context.clip();
  context.imageSmoothingEnabled = show.zoom < 4 && !Number.isInteger(show.zoom);  // uneven pixels look like a grid
  context.drawImage(picture(name), show.panX, show.panY, width * show.zoom, height * show.zoom);
  context.restore();
}

const dividerX = () => show.panX + show.divider * width * show.zoom;

function redraw() {
  if (!layers.length) return;
  context.clearRect(0, 0, canvas.width, canvas.height);
  const names = data.names;
  const labels = { swipe: [names.a, names.b], flicker: [show.flickerA ? names.a : names.b, ""], a: [names.a, ""],
                   b: [names.b, ""], difference: [`${names.a} − ${names.b}`, ""], error: ["relative error", ""] };
  if (show.mode === "swipe") {
    const x = Math.min(Math.max(dividerX(), 0), canvas.width);
    drawPicture("a", 0, x);
    drawPicture("b", x, canvas.width);
    context.fillStyle = "#fff";
    context.fillRect(x - ratio(), 0, 2 * ratio(), canvas.height);
    context.beginPath();
    context.arc(x, canvas.height / 2, 9 * ratio(), 0, 2 * Math.PI);
    context.fill();
  } else {
    const name = show.mode === "flicker" ? (show.flickerA ? "a" : "b") : show.mode;
    drawPicture(name, 0, canvas.width);
  }
  [element("left-label").textContent, element("right-label").textContent] = labels[show.mode];
  drawMarker();
  updateControls();
}

/** The pixel that the values below belong to, outlined once pixels are large enough to see one. */
function drawMarker() {
  if (show.zoom < 6) return;
  context.strokeStyle = "#fff";
  context.lineWidth = ratio();
  const [x, y] = show.pixel;
  context.strokeRect(show.panX + x * show.zoom, show.panY + y * show.zoom, show.zoom, show.zoom);
}

const digits = (value) =>
  Number.isFinite(value) ? String(Number(value.toPrecision(3))).replace("-", "−") : "not finite";

function updateControls() {
  for (const button of element("modes").children)
    button.setAttribute("aria-checked", String(button.dataset.mode === show.mode));
  element("layer").value = String(show.layer);
  element("exposure").value = String(show.exposure);
  element("tone").value = show.tone;
  const sign = show.exposure >= 0 ? "+" : "−";
  element("exposure-value").textContent = `${sign}${Math.abs(show.exposure).toFixed(2)} stops`;
  element("range-value").textContent = "± " + digits(show.range);
  element("exposure-choice").hidden = ["difference", "error"].includes(show.mode);  // they show numbers, not light
  element("tone-choice").hidden = element("exposure-choice").hidden;
  element("range-choice").hidden = show.mode !== "difference";
  updateBar();
  updateReadout();
}

function updateBar() {
  const map = {
    difference:
      [data.cool_warm, digits(-show.range), `${data.names.a} darker · luminance · ${data.names.a} brighter`, "+" + digits(show.range)],
    error: [data.inferno, "0", `|${data.names.a} − ${data.names.b}| / max(${data.names.b}, 1 % of its mean)`, "100 % and more"],
  }[show.mode];
  element("bar").hidden = !map;
  if (!map) return;
  const bar = element("bar-canvas").getContext("2d");
  for (let x = 0; x < 512; ++x) {
    bar.fillStyle = `rgb(${mapColor(map[0], (x + 0.5) / 512).map(Math.round).join(",")})`;
    bar.fillRect(x, 0, 1, 1);
  }
  [element("bar-low").textContent, element("bar-name").textContent, element("bar-high").textContent] = map.slice(1);
}

function updateReadout() {
  const [x, y] = show.pixel, i = y * width + x, layer = layers[show.layer];
  const values = (rgb) => [rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], luminance(rgb, i)];
  const rows = { a: values(layer.a), b: values(layer.b), difference: values(layer.difference) };
  element("readout-place").textContent =
    data.factor > 1 ? `pixel (${x}, ${y}), mean of ${data.factor} × ${data.factor}` : `pixel (${x}, ${y})`;
  for (const [name, row] of Object.entries(rows))
    row.forEach((value, c) => { element("readout-" + name).cells[c + 1].textContent = digits(value); });
}

// ---------------------------------------------------------------------------------------------- what the user does

const actions = {
  mode(name) { show.mode = name; redraw(); },
  alternate() {
    if (show.mode !== "flicker") show.mode = show.mode === "a" ? "b" : "a";
    else show.flickerA = !show.flickerA;
    redraw();
  },
  layer(index) { show.layer = index % layers.length; show.range = automaticRange(); pictures = {}; redraw(); },
  exposure(stops) {
    const limits = element("exposure");
    show.exposure = Math.min(Math.max(stops, Number(limits.min)), Number(limits.max));
    delete pictures.a;
    delete pictures.b;
    redraw();
  },
  tone(name) {
    show.tone = name;
    delete pictures.a;
    delete pictures.b;
    redraw();
  },
  range(up) {
    const mantissa = Math.round(show.range / 10 ** Math.floor(Math.log10(show.range) + 1e-9));
    show.range *= up ? { 1: 2, 2: 2.5, 5: 2 }[mantissa] : { 1: 0.5, 2: 0.5, 5: 0.4 }[mantissa];
    delete pictures.difference;
    redraw();
  },
  zoom(factor) { setZoom(show.zoom * factor); redraw(); },
  pan(x, y) { show.panX += x * 40 * ratio(); show.panY += y * 40 * ratio(); redraw(); },
  divider(step) { show.divider = Math.min(Math.max(show.divider + step, 0), 1); redraw(); },
};

function onKey(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || ["SELECT", "INPUT"].includes(event.target.tagName)) return;
  if (event.key === " " && ["BUTTON", "SUMMARY"].includes(event.target.tagName)) return;  // presses or unfolds it
  const arrows = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const keys = {
    " ": actions.alternate, 0: fit,
    "+": () => actions.zoom(2), "=": () => actions.zoom(2), "-": () => actions.zoom(0.5),
    e: () => actions.exposure(show.exposure + 0.25), d: () => actions.exposure(show.exposure - 0.25),
    r: () => actions.exposure(data.exposure), "[": () => actions.range(false), "]": () => actions.range(true),
    l: () => actions.layer(show.layer + 1), t: () => actions.tone(show.tone === "clip" ? "reinhard" : "clip"),
    ArrowLeft: () => actions.divider(-0.01), ArrowRight: () => actions.divider(0.01),
  };
  modes.forEach((mode, i) => { keys[i + 1] = () => actions.mode(mode.name); });
  const arrow = arrows[event.key];
  if (arrow && !event.shiftKey && show.mode !== "swipe") return;  // scrolls the page
  const action = arrow && event.shiftKey ? () => actions.pan(...arrow)
                                         : keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!action) return;
  event.preventDefault();
  action();
}

/** Place of a pointer event in canvas pixels. */
function place(event) {
  const box = canvas.getBoundingClientRect();
  return [(event.clientX - box.left) * ratio(), (event.clientY - box.top) * ratio()];
}

function listenToPointer() {
  let drag = null;  // "divider" or "pan"
  canvas.addEventListener("pointerdown", (event) => {
    const near = show.mode === "swipe" && Math.abs(place(event)[0] - dividerX()) < 20 * ratio();
    drag = near ? "divider" : "pan";
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    const [x, y] = place(event);
    const column = Math.floor((x - show.panX) / show.zoom), row = Math.floor((y - show.panY) / show.zoom);
    if (column >= 0 && row >= 0 && column < width && row < height) show.pixel = [column, row];
    if (drag === "divider") show.divider = Math.min(Math.max((x - show.panX) / (width * show.zoom), 0), 1);
    if (drag === "pan") { show.panX += event.movementX * ratio(); show.panY += event.movementY * ratio(); }
    if (drag || show.zoom >= 6) redraw(); else updateReadout();
  });
  for (const type of ["pointerup", "pointercancel"]) canvas.addEventListener(type, () => { drag = null; });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    setZoom(show.zoom * 2 ** (-event.deltaY / 400), ...place(event));
    redraw();
  }, { passive: false });
}

function listen() {
  for (const { name, label } of modes) {
    const button = document.createElement("button");
    Object.assign(button, { type: "button", textContent: label });
    button.setAttribute("role", "radio");
    button.dataset.mode = name;
    button.addEventListener("click", () => actions.mode(name));
    element("modes").append(button);
  }
  layers.forEach((layer, i) => element("layer").append(new Option(layer.name, String(i))));
  element("layer-choice").hidden = layers.length < 2;
  element("layer").addEventListener("change", (event) => actions.layer(Number(event.target.value)));
  element("exposure").min = String(Math.floor(data.exposure) - 8);
  element("exposure").max = String(Math.floor(data.exposure) + 8);
  element("exposure").addEventListener("input", (event) => actions.exposure(Number(event.target.value)));
  element("tone").addEventListener("change", (event) => actions.tone(event.target.value));
  element("range-down").addEventListener("click", () => actions.range(false));
  element("range-up").addEventListener("click", () => actions.range(true));
  element("zoom-in").addEventListener("click", () => actions.zoom(2));
  element("zoom-out").addEventListener("click", () => actions.zoom(0.5));
  element("zoom-fit").addEventListener("click", fit);
  element("zoom-one").addEventListener("click", () => { setZoom(Math.max(1, Math.round(ratio()))); redraw(); });
  document.addEventListener("keydown", onKey);
  window.addEventListener("resize", fit);
  setInterval(() => { if (show.mode === "flicker") { show.flickerA = !show.flickerA; redraw(); } }, 600);
  listenToPointer();
}

/** The page says how far it came in its root element, for tests, and in words where it failed. */
function fail(message) {
  document.documentElement.dataset.state = "failed";
  element("failure").hidden = false;
  element("failure").textContent = "The images cannot be shown: " + message;
}
window.addEventListener("error", (event) => fail(event.message));

async function start() {
  layers = await Promise.all(data.layers.map(async (layer) => {
    const read = async (png, bits, signed) => decode(await readPng(png), bits, signed);
    const [a, b, difference] = await Promise.all([read(layer.a, layer.bits, layer.signed),
      read(layer.b, layer.bits, layer.signed), read(layer.difference, layer.difference_bits, true)]);
    return { name: layer.name, a, b, difference };
  }));
  show.range = automaticRange();
  listen();
  // A link to report.html#difference opens the page there.
  if (modes.some((mode) => "#" + mode.name === location.hash)) show.mode = location.hash.slice(1);
  fit();
  document.documentElement.dataset.state = "ready";
}
start().catch((error) => fail(error.message));
