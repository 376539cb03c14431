// The ultrasound image: to scale, with rulers, and the knobs of a scanner. Settings are us-slice's, and each change is
// a line for it.

import {isEqual} from "./protocol.js";
import {metres} from "./shapes.js";
import {byId, Drawing, element, exactly, figures, paced, Slider} from "./widgets.js";

const TGC = 6;
const HOLD = 600;  // ms: as of sliders
const INK = "#8b979f";
const MARK = "#f2a93b";

const KNOBS = [
    {key: "gain", label: "Gain", unit: "dB", min: -40, max: 40, step: 0.5, help: "Brightens the whole image"},
    {
        key: "dynamic-range",
        label: "Dynamic range",
        unit: "dB",
        min: 10,
        max: 120,
        step: 1,
        help: "Echoes this far below the strongest are shown"
    },
    {key: "depth", label: "Depth", unit: "mm", min: 10, max: 250, step: 1, help: "How deep the image reaches"},
    {
        key: "thickness",
        label: "Beam",
        unit: "mm",
        min: 0,
        max: 20,
        step: 0.5,
        help: "Thickness of the beam; 0: one slice"
    },
];

// A setting's text as the number of its knob, and back.
const fromText = {
    gain: (text) => Number(text),
    "dynamic-range": (text) => Number(text.split(",")[0]),
    depth: (text) => 1000 * metres(text),
    thickness: (text) => 1000 * metres(text.split(",")[0]),
};
const toText = {
    gain: exactly,
    "dynamic-range": (value, before) => [exactly(value), ...before.split(",").slice(1)].join(","),
    depth: (value) => `${exactly(value)}mm`,
    thickness: (value) => (value > 0 ? `${exactly(value)}mm` : "0"),
};

// 1, 2 or 5 times a power of ten: about as far apart as asked.
export function niceStep(least) {
    const power = 10 ** Math.floor(Math.log10(least));
    return power * ([1, 2, 5].find((x) => x * power >= least * 0.999) || 10);
}

// Its size and where it stands, as a text.
const placeOf = (image) => [image.columns, image.rows, ...image.origin, ...image.column, ...image.row].join();

export class Image extends Drawing {
    // set(key, value): a line to us-slice; shown(image, pixels): a canvas has its pixels; null: they are as before.
    constructor(set, shown) {
        super(byId("image"), byId("image-room"));
        this.pixels = element("canvas");  // as the image has them
        this.version = 0;                 // how many there were
        this.sets = {};
        this.setAny = (key, value) => (this.sets[key] = this.sets[key] || paced(40, (v) => set(key, v)))(value);
        this.shown = shown;
        this.now = null;
        this.texts = {};
        this.knobs = {};
        this.build();
    }

    // ---- knobs

    build() {
        for (const knob of KNOBS) {
            const change = (value) => this.change(knob.key, toText[knob.key](value, this.texts[knob.key] || ""));
            this.knobs[knob.key] = new Slider({...knob, change, named: `image ${knob.key}`});
        }
        byId("knobs").replaceChildren(...Object.values(this.knobs).map((slider) => slider.row));
        this.tgc = Array.from({length: TGC}, (_, i) => this.gainAt(i));
        const flat = element("button", {title: "All gains of the depth 0 dB", onclick: () => this.flatten()}, "Flat");
        const name =
            element("span", {class: "name", title: "Time-gain compensation, from the face to the depth"}, "TGC");
        this.gains = element("div", {class: "gains"}, ...this.tgc, flat);
        byId("tgc").replaceChildren(name, this.gains);
        this.freeze = byId("freeze");
        this.freeze.addEventListener("click", () => this.change("freeze", this.frozen() ? "off" : "on"));
        this.labels = byId("labels");
        this.labels.addEventListener("change", () => this.change("labels", this.labels.checked ? "on" : "off"));
    }

    gainAt(i) {
        const title = `Gain at ${Math.round((100 * i) / (TGC - 1))} % of the depth, -30 to 30 dB`;
        const range =
            element("input", {type: "range", min: -30, max: 30, step: 1, value: 0, title, "aria-label": title});
        range.addEventListener("input", () => {
            this.touched = performance.now();
            range.title = `${title}: ${range.value} dB`;
            this.change("tgc", this.tgc.map((each) => each.value).join(","));
        });
        return range;
    }

    flatten() {
        for (const range of this.tgc) range.value = 0;
        this.change("tgc", this.tgc.map(() => "0").join(","));
    }

    frozen() {
        return this.texts.freeze === "on";
    }

    change(key, text) {
        this.texts[key] = text;
        this.setAny(key, text);
        this.show();
    }

    // What the server says of us-slice's settings.
    setSettings(settings) {
        for (const [key, setting] of Object.entries(settings || {})) this.texts[key] = String(setting.value);
        for (const [key, slider] of Object.entries(this.knobs)) {
            const setting = (settings || {})[key];
            slider.row.hidden = !setting;
            if (setting) slider.set(fromText[key](this.texts[key]), 2);
        }
        this.showGains(settings);
        this.labels.parentElement.hidden = !(settings || {}).labels;
        this.labels.checked = this.texts.labels === "on";
        this.show();
    }

    showGains(settings) {
        clearTimeout(this.later);
        const wait = (this.touched || -HOLD) + HOLD - performance.now();
        if (wait > 0) {
            this.later = setTimeout(() => this.showGains(settings), wait);
            return;
        }
        byId("tgc").hidden = !(settings || {}).tgc;
        const gains = (this.texts.tgc || "0").split(",").map(Number);
        // Fewer gains than sliders: those between lie on straight lines.
        this.tgc.forEach((range, i) => {
            const at = (i / (TGC - 1)) * (gains.length - 1);
            const low = Math.floor(at);
            const next = Math.min(low + 1, gains.length - 1);
            const value = gains[low] + (at - low) * (gains[next] - gains[low]);
            range.value = value;
        });
    }

    show() {
        this.freeze.setAttribute("aria-pressed", this.frozen());
        this.draw();
    }

    // The fan that the image is of, or null.
    fan(pressing) {
        const [kind, rest = ""] = (this.texts.probe || pressing || "").split(":");
        const words = rest.split(",");
        if (kind === "curved") return {radius: metres(words[0]), angle: (Number(words[1]) * Math.PI) / 180};
        if (kind === "phased") return {radius: 0, angle: (Number(words[0]) * Math.PI) / 180};
        return null;
    }

    // ---- pixels

    // given: an ImageBitmap, or bytes, grey or RGB; null where the pixels are those of the image before.
    take(image, pixels) {
        const given = pixels && this.raw && isEqual(pixels, this.raw) ? null : pixels;
        const isSame = !given && this.now && placeOf(this.now) === placeOf(image);
        if (given) this.put(image, given);
        if (!this.version) return;
        this.now = image;
        if (!isSame) this.draw();
        this.shown(image, isSame ? null : this.pixels);
    }

    put({columns, rows}, given) {
        this.version++;
        if (this.pixels.width !== columns || this.pixels.height !== rows)
            Object.assign(this.pixels, {width: columns, height: rows});
        // In memory, where it is read again, by the view too.
        const to = this.pixels.getContext("2d", {alpha: false, willReadFrequently: true});
        this.raw = given instanceof Uint8Array ? given : null;
        if (this.raw) {
            to.putImageData(this.opaque(given, columns, rows), 0, 0);
            return;
        }
        to.drawImage(given, 0, 0);
        given.close();
    }

    // As RGBA, in memory that the next image has too.
    opaque(bytes, columns, rows) {
        if (!this.data || this.data.width !== columns || this.data.height !== rows)
            this.data = new ImageData(columns, rows);
        const words = new Uint32Array(this.data.data.buffer);
        if (bytes.length === words.length)
            for (let i = 0; i < words.length; i++) words[i] = 0xff000000 | (0x10101 * bytes[i]);
        else
            for (let i = 0, j = 0; i < words.length; i++, j += 3)
                words[i] = 0xff000000 | (bytes[j + 2] << 16) | (bytes[j + 1] << 8) | bytes[j];
        return this.data;
    }

    clear() {
        this.now = null;
        this.draw();
    }

    // m a pixel, along a row and down a column.
    static spacing(image) {
        return [Math.hypot(...image.column), Math.hypot(...image.row)];
    }

    paint(to, width, height) {
        to.fillStyle = "#000";
        to.fillRect(0, 0, width, height);
        this.layout = this.now ? this.layoutIn(width, height) : null;
        if (!this.layout) return;
        const {left, top, wide, high} = this.layout;
        to.drawImage(this.pixels, left, top, wide, high);
        // Beside the depths that they are of, unless the image is too low for that.
        this.gains.style.top = `${top}px`;
        this.gains.style.height = `${Math.max(high, 20 * this.layout.em)}px`;
        this.rulers(to);
        if (this.frozen()) this.tell(to, "frozen");
    }

    // As large as fits, both sides to one scale.
    layoutIn(width, height) {
        const em = parseFloat(getComputedStyle(document.documentElement).fontSize);
        const [x, y] = Image.spacing(this.now);
        const [across, down] = [x * this.now.columns, y * this.now.rows];
        const room = [width - 4 * em, height - 3.4 * em];
        const scale = Math.min(room[0] / across, room[1] / down);  // CSS pixels a metre
        const [wide, high] = [across * scale, down * scale];
        return {left: 2.8 * em + (room[0] - wide) / 2, top: 2.2 * em, wide, high, scale, em, across, down};
    }

    rulers(to) {
        const {left, top, wide, high, scale, em} = this.layout;
        Object.assign(to, {fillStyle: INK, strokeStyle: INK, lineWidth: Math.max(em / 15, 1), textBaseline: "middle"});
        to.font = `${0.8 * em}px system-ui, sans-serif`;
        const step = niceStep((2.2 * em) / scale);
        const parts = Math.round(step / 10 ** Math.floor(Math.log10(step * 1.001))) === 2 ? 4 : 5;
        const tick = (i) => (i % parts === 0 ? 0.55 : 0.3) * em;
        to.beginPath();
        for (let i = 0; (i * step) / parts <= high / scale + 1e-9; i++) {
            const y = top + (i * step * scale) / parts;
            to.moveTo(left - 0.3 * em, y);
            to.lineTo(left - 0.3 * em - tick(i), y);
        }
        for (let i = 0; (i * step) / parts <= wide / scale + 1e-9; i++) {
            const x = left + (i * step * scale) / parts;
            to.moveTo(x, top - 0.3 * em);
            to.lineTo(x, top - 0.3 * em - tick(i));
        }
        to.stroke();
        this.numbers(to, step);
        to.fillStyle = MARK;  // the side of the probe's mark
        to.beginPath();
        to.arc(left + wide + 0.7 * em, top + 0.5 * em, 0.3 * em, 0, 2 * Math.PI);
        to.fill();
    }

    numbers(to, step) {
        const {left, top, wide, high, scale, em} = this.layout;
        const text = (i) => figures(1000 * i * step, step < 0.001 ? 2 : 1);
        to.textAlign = "right";
        for (let i = 0; i * step <= high / scale + 1e-9; i++) to.fillText(text(i), left - em, top + i * step * scale);
        to.textAlign = "center";
        for (let i = 1; i * step <= wide / scale + 1e-9; i++)
            to.fillText(text(i), left + i * step * scale, top - 1.4 * em);
        to.fillText("mm", left - 1.2 * em, top - 1.4 * em);
    }

    tell(to, text) {
        const {left, top, em} = this.layout;
        to.textAlign = "left";
        to.fillStyle = "#7cc4e0";
        to.font = `600 ${em}px system-ui, sans-serif`;
        to.fillText(text, left + 0.6 * em, top + em);
    }
}
