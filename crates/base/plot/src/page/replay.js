for (const root of document.querySelectorAll(".replay")) {
  const { bounds: [low, high], unit, marks, colours, presses } = JSON.parse(root.querySelector("script").textContent);
  const [choice, slider, output] = ["select", "input", "output"].map((tag) => root.querySelector(tag));
  const made = (tag, parent, attributes) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return parent.appendChild(element);
  };
  const size = [high[0] - low[0], high[1] - low[1]];
  const least = Math.min(...marks.map(([, a], i) => Math.min(...marks.map(([, b], j) => (i === j ? Infinity : Math.hypot(a[0] - b[0], a[1] - b[1]))))));
  const radius = Math.min(0.38 * least, 0.2 * Math.max(...size));
  /* y points up, as in the other plans. */
  const plans = [...root.querySelectorAll("svg")].map((svg) => {
    svg.setAttribute("viewBox", [low[0] - 1, -high[1] - 1, size[0] + 2, size[1] + 2].join(" "));
    made("rect", svg, { class: "gel", x: low[0], y: -high[1], width: size[0], height: size[1], rx: 0.5 });
    const taxels = marks.map(([, [x, y]]) => ({
      circle: made("circle", svg, { cx: x, cy: -y, r: radius }),
      number: made("text", svg, { x, y: -y, "font-size": 0.62 * radius }),
    }));
    return { taxels, place: made("circle", svg, { class: "place", r: 1.15 * radius }) };
  });
  const colourOf = (part) => {
    const at = Math.min(1, Math.max(0, part)) * (colours.length - 1);
    const below = Math.min(Math.floor(at), colours.length - 2);
    return colours[below].map((c, i) => Math.round(c + (at - below) * (colours[below + 1][i] - c)));
  };
  const show = () => {
    const { place, depth, values } = presses[choice.value];
    const frame = Number(slider.value);
    const most = Math.max(1e-9, ...values.flat(2));
    values.forEach((frames, source) => {
      plans[source].place.setAttribute("cx", place[0]);
      plans[source].place.setAttribute("cy", -place[1]);
      frames[frame].forEach((value, taxel) => {
        const { circle, number } = plans[source].taxels[taxel];
        const colour = value === null ? [153, 153, 153] : colourOf(value / most);
        circle.setAttribute("fill", `rgb(${colour})`);
        number.setAttribute("fill", colour[1] > 140 ? "#000" : "#fff");
        number.textContent = value === null ? "–" : value.toFixed(1);
      });
    });
    const deep = depth[frame] === null ? "depth unknown" : `${depth[frame].toFixed(2)} mm deep`;
    output.value = `${deep}; numbers in ${unit}`;
    slider.setAttribute("aria-valuetext", output.value);
  };
  const choose = () => {
    const { depth } = presses[choice.value];
    slider.max = depth.length - 1;
    slider.value = Math.max(0, depth.indexOf(Math.max(...depth.filter((mm) => mm !== null))));
    show();
  };
  choice.addEventListener("change", choose);
  slider.addEventListener("input", show);
  choose();
}
