// The scale of colours of sinew render (common/picture/colourmap.c): dark violet over green to yellow, equal steps of a
// value being equal steps in Oklab. The path's steps are made equal over 256 places.

const STEPS = 256;
const FINE = 2048;
const degree = Math.PI / 180;

function fromOklab([L, a, b]) {
    const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
    return [
        4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
        -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
        -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
    ];
}

// Chroma gives way until a screen can show it.
function byHue(lightness, chroma, hue) {
    for (let less = 0; less < 64; less++) {
        const c = (chroma * (64 - less)) / 64;
        const lab = [lightness, c * Math.cos(hue * degree), c * Math.sin(hue * degree)];
        if (fromOklab(lab).every((x) => x >= 0 && x <= 1)) return lab;
    }
    return [lightness, 0, 0];
}

function path(s) {
    const middle = (2 * s - 1) ** 2;
    return byHue(0.31 + 0.61 * s, 0.102 + (s < 0.5 ? 0.04 : 0.075) * middle, 310 - 203 * s);
}

const toScreen = (x) => {
    const clear = Math.min(Math.max(x, 0), 1);
    return Math.round(255 * (clear <= 0.0031308 ? 12.92 * clear : 1.055 * clear ** (1 / 2.4) - 0.055));
};

// 256 x RGBA, as bytes of a screen's colours.
export function scaleBytes() {
    const length = [0];
    let last = path(0);
    for (let i = 1; i <= FINE; i++) {
        const lab = path(i / FINE);
        length.push(length[i - 1] + Math.hypot(lab[0] - last[0], lab[1] - last[1], lab[2] - last[2]));
        last = lab;
    }
    const bytes = new Uint8Array(4 * STEPS);
    for (let k = 0, i = 0; k < STEPS; k++) {
        const want = (length[FINE] * k) / (STEPS - 1);
        while (i < FINE - 1 && length[i + 1] < want) i++;
        const step = length[i + 1] - length[i];
        const rgb = fromOklab(path((i + (step > 0 ? (want - length[i]) / step : 0)) / FINE));
        bytes.set([...rgb.map(toScreen), 255], 4 * k);
    }
    return bytes;
}

// Draws the scale from left to right over a canvas.
export function drawScale(canvas) {
    const bytes = scaleBytes();
    canvas.width = STEPS;
    canvas.height = 1;
    canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(bytes), STEPS, 1), 0, 0);
}
