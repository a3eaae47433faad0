// Ids of planes as text on a canvas, for both views.

/** Writes an id in a dark pill at a point of the canvas. */
export function writeId(context, text, [x, y], colour, chosen) {
    context.font = `600 ${chosen ? 14 : 12}px system-ui, "DejaVu Sans", sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    const width = context.measureText(text).width + 12;
    context.beginPath();
    context.roundRect(x - width / 2, y - 10, width, 20, 10);
    context.fillStyle = chosen ? "#e8f1ff" : "#0f1216d8";
    context.fill();
    context.lineWidth = 1.5;
    context.strokeStyle = colour;
    context.stroke();
    context.fillStyle = chosen ? "#0f1216" : "#f2f5f8";
    context.fillText(text, x, y + 0.5);
}

/** Makes a canvas as fine as the screen; returns its context in units of the page. */
export function fitted(canvas) {
    const { clientWidth: width, clientHeight: height } = canvas;
    const ratio = window.devicePixelRatio || 1;
    const [columns, rows] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (canvas.width !== columns || canvas.height !== rows) Object.assign(canvas, { width: columns, height: rows });
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    return { context, width, height };
}
