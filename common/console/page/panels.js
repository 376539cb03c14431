// The panels around the views: cases, method and parameters, what is shown, forces, what tools said.

import {Chart} from "./chart.js";
import {byId, element, figures, renew} from "./widgets.js";

const METHODS = {
    msds: "springs",
    fem: "finite elements, iterated",
    exact: "finite elements, exact",
    warp: "corotational, iterated",
    "exact-warp": "corotational, exact",
    tissue: "large strains, iterated",
};
const SAID = 200;     // messages that are kept
const SHOWN = 12000;  // ms: a warning; an error stays until it is dismissed

// ---- cases

export class Cases {
    constructor(open) {
        this.open = open;
        this.dialog = byId("cases");
        byId("case").addEventListener("click", () => this.dialog.showModal());
    }

    set(state) {
        byId("case-name").textContent = state.case || "No case";
        document.title = state.case ? `${state.case} – Sinew` : "Sinew";
        this.first = (state.cases || []).map((each) => each.name)[0];
        renew(byId("case-list"), JSON.stringify([state.cases, state.case]),
            () => (state.cases || []).map((each) => this.card(each, state.case)));
        byId("no-cases").hidden = (state.cases || []).length > 0;
    }

    card(each, now) {
        const picture = each.picture ? element("img", {src: pictureOf(each), alt: "", loading: "lazy"})
                                     : element("span", {class: "no-picture"}, each.name.slice(0, 1).toUpperCase());
        const choose = () => {
            this.dialog.close();
            this.open(each.name);
        };
        return element("button", {
            class: "card",
            title: `Open ${each.name}`,
            "aria-current": each.name === now ? "true" : null,
            onclick: choose,
            autofocus: each.name === (now || this.first)
        },
            picture, element("span", {}, each.name));
    }
}

function pictureOf(each) {
    return typeof each.picture === "string" ? each.picture : `/case/${encodeURIComponent(each.name)}/picture.png`;
}

// ---- method and parameters

export class Method {
    // send(line).
    constructor(send) {
        this.send = send;
        this.dialog = byId("parameters");
        this.select = byId("method");
        this.select.addEventListener("change", () => send(`method ${this.select.value}`));
        byId("open-parameters").addEventListener("click", () => this.dialog.showModal());
        this.fields = new Map();
    }

    set(tool) {
        this.tool = tool.name;
        const methods = tool.methods || (tool.name === "msds-run" || tool.method ? Object.keys(METHODS) : []);
        byId("method-row").hidden = !methods.length;
        renew(this.select, methods.join(),
            () => methods.map((name) => element("option", {value: name, title: METHODS[name] || name},
                                  METHODS[name] ? `${name}: ${METHODS[name]}` : name)));
        if (tool.method && document.activeElement !== this.select) this.select.value = tool.method;
        if (tool.method && tool.method !== this.told) this.select.value = this.told = tool.method;
        const settings = Object.entries(tool.settings || {});
        byId("open-parameters").hidden = !settings.length;
        byId("parameters-of").textContent = tool.name || "";
        const names = settings.map(([key, setting]) => [key, setting.default, setting.choices]);
        if (renew(byId("parameter-list"), JSON.stringify(names), () => this.rows(settings))) this.told = null;
        for (const [key, setting] of settings) this.showValue(key, setting);
    }

    rows(settings) {
        this.fields.clear();
        return settings.map(([key, setting]) => this.row(key, setting));
    }

    // A key, a value with its unit, its default, what it means.
    row(key, setting) {
        const id = `set-${key}`;
        const title = [setting.help, range(setting), setting.unit && `in ${setting.unit}`].filter(Boolean).join("; ");
        const field = setting.choices
            ? element("select", {id, title}, ...setting.choices.map((name) => element("option", {value: name}, name)))
            : element("input", {id, title, type: "text", spellcheck: "false", autocomplete: "off"});
        field.addEventListener("change", () => this.change(key, field.value.trim()));
        this.fields.set(key, field);
        const back = () => {
            field.value = setting.default;
            this.change(key, String(setting.default));
        };
        return element("div", {class: "parameter"}, element("label", {"for": id}, key), field,
            element("span", {class: "unit"}, setting.unit || ""),
            element("button", {title: `Back to the default, ${setting.default}`, onclick: back},
                `default ${setting.default}`),
            element("p", {}, [setting.help, range(setting)].filter(Boolean).join("; ")));
    }

    // What changes of a face are verbs of its script.
    change(key, value) {
        if (value) this.send(`${this.tool === "tled-run" ? "now" : "set"} ${key} ${value.replace(/\s+/g, "")}`);
    }

    showValue(key, setting) {
        const field = this.fields.get(key);
        if (document.activeElement !== field) field.value = setting.value;
        field.classList.toggle("changed", String(setting.value) !== String(setting.default));
    }
}

function range({min, max}) {
    if (Number.isFinite(min) && Number.isFinite(max)) return `${min} to ${max}`;
    if (Number.isFinite(min)) return `at least ${min}`;
    return Number.isFinite(max) ? `at most ${max}` : "";
}

// ---- what is shown

export class Shown {
    constructor(view) {
        this.view = view;
        this.case = null;
    }

    // After a new geometry.
    set(name) {
        this.case = name;
        this.kept = JSON.parse(sessionStorage.getItem(`shown ${name}`) || "{}");
        const rows = [...this.view.items.values()].map((item) => this.surface(item));
        if (this.view.probe || this.view.shapeWords) rows.push(this.other("probe", "#c9cfd4", false));
        if (this.hasImage) rows.push(this.other("image", "#000000", true));
        byId("shown-list").replaceChildren(...rows);
    }

    keep(name, what) {
        this.kept[name] = {...this.kept[name], ...what};
        sessionStorage.setItem(`shown ${this.case}`, JSON.stringify(this.kept));
    }

    surface(item) {
        const kept = {visible: item.kind !== "mesh" || !this.hasSkin(), opacity: item.opacity, ...this.kept[item.name]};
        const show = (visible, opacity) => this.view.show(item, visible, opacity);
        return this.row(item.name, item.colour, kept, true, show);
    }

    hasSkin() {
        return [...this.view.items.values()].some((item) => item.kind === "skin");
    }

    other(name, colour, fades) {
        const show = (visible, opacity) =>
            (name === "probe" ? this.view.showProbe(visible) : this.view.showImage(visible, opacity));
        return this.row(name, colour, {visible: true, opacity: 1, ...this.kept[name]}, fades, show);
    }

    row(name, colour, start, fades, show) {
        const now = {visible: start.visible, opacity: start.opacity};
        const take = (what) => {
            Object.assign(now, what);
            show(now.visible, now.opacity);
            this.keep(name, now);
        };
        const box = element("input",
            {type: "checkbox", id: `show-${name}`, "aria-label": `Show ${name}`, title: `Show or hide ${name}`});
        box.checked = now.visible;
        box.addEventListener("change", () => take({visible: box.checked}));
        const title = `How solid ${name} is, 10 to 100 %`;
        const solid = element("input", {
            type: "range",
            min: 10,
            max: 100,
            step: 5,
            value: Math.round(100 * now.opacity),
            title,
            "aria-label": title
        });
        solid.addEventListener("input", () => take({opacity: Number(solid.value) / 100}));
        show(now.visible, now.opacity);
        const swatch = element("span", {class: "swatch"});
        swatch.style.background = colour;
        return element("div", {class: "shown"}, box, element("label", {"for": `show-${name}`}, swatch, name),
            fades ? solid : null);
    }
}

// ---- forces

// Numbers with as many decimals as the largest needs.
function together(list) {
    const most = Math.max(...list.map(Math.abs), 0);
    const decimals = Math.min(Math.max(2 - Math.floor(Math.log10(most || 1)), 0), 3);
    return list.map((x) => (Math.round(x * 10 ** decimals) / 10 ** decimals + 0).toFixed(decimals)).join("  ");
}

export class Forces {
    constructor() {
        this.chart = new Chart(byId("force-chart"), "N");
    }

    add(frame) {
        if (!frame.force) return;
        const size = Math.hypot(...frame.force);
        byId("force").textContent = `${figures(size)} N`;
        byId("force-parts").textContent = together(frame.force);
        // mN m, to a thousandth: less is rounding.
        const torque = (frame.torque || []).map((x) => Math.round(1e6 * x) / 1e3);
        byId("torque").textContent = frame.torque ? `${figures(Math.hypot(...torque))} mN m` : "–";
        byId("torque-parts").textContent = together(torque);
        byId("contacts").textContent = Number.isFinite(frame.contacts) ? `${frame.contacts} nodes touch` : "";
        this.chart.add(frame.time, size);
    }

    clear() {
        this.chart.clear();
        for (const id of ["force", "torque"]) byId(id).textContent = "–";
        for (const id of ["force-parts", "torque-parts", "contacts"]) byId(id).textContent = "";
    }
}

// ---- what tools said

export class Said {
    constructor() {
        this.lines = [];
        this.dialog = byId("messages");
        byId("open-messages").addEventListener("click", () => this.dialog.showModal());
        byId("dismiss").addEventListener("click", () => (byId("alert").hidden = true));
    }

    add({level = "info", tool = "", text = "", href = null}) {
        this.lines.push({level, tool, text});
        const link =
            typeof href === "string" && href.startsWith("/") ? element("a", {href, download: ""}, " fetch it") : null;
        const line = element("li", {class: level}, tool ? element("b", {}, tool) : null, tool ? " " : "", text, link);
        byId("message-list").append(line);
        while (byId("message-list").children.length > SAID) byId("message-list").firstChild.remove();
        byId("message-count").textContent = String(this.lines.length);
        if (level === "info" && !link) return;
        byId("alert").className = level;
        byId("alert-text").replaceChildren(...line.cloneNode(true).childNodes);
        byId("alert").hidden = false;
        clearTimeout(this.fades);
        if (level !== "error") this.fades = setTimeout(() => (byId("alert").hidden = true), SHOWN);
    }
}
