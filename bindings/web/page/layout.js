// Whether the two views lie side by side, or one above the other: in whichever way the picture is larger.

/** Least width of `main`, above which there is a choice; the style sheet has it as well. */
const LEAST_PX = 1150;
const ASIDE_PX = 372;
const BAR_PX = 42;

export function arrange(main, { width, height }) {
    const [wide, high] = [main.clientWidth - ASIDE_PX, main.clientHeight];
    const zoom = (across, down) => Math.min(across / width, (down - BAR_PX) / height);
    main.classList.toggle("stacked", main.clientWidth > LEAST_PX && zoom(wide, high / 2) > zoom(wide / 2, high));
}
