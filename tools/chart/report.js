"use strict";
(function () {
    const root = document.documentElement;
    const tip = document.getElementById("tip");
    const button = document.getElementById("theme");
    const system = matchMedia("(prefers-color-scheme: dark)");

    /* light or dark: as the system asks, until the button says otherwise */

    function isDark() {
        return root.dataset.theme ? root.dataset.theme === "dark"
                                  : system.matches;
    }

    function nameButton() {
        button.textContent = isDark() ? "Light page" : "Dark page";
    }

    button.addEventListener("click", function () {
        root.dataset.theme = isDark() ? "light" : "dark";
        nameButton();
    });
    system.addEventListener("change", nameButton);
    nameButton();
    button.hidden = false;

    /* what is said of a point, beside it */

    function show(mark) {
        const box = mark.getBoundingClientRect();

        tip.textContent = mark.getAttribute("aria-label");
        tip.hidden = false;
        const x = Math.min(box.right + 8, innerWidth - tip.offsetWidth - 8);
        const above = box.top - tip.offsetHeight - 8;
        tip.style.left = Math.max(8, x) + "px";
        tip.style.top = (above > 8 ? above : box.bottom + 8) + "px";
    }

    function hide() {
        tip.hidden = true;
    }

    function middle(mark) {
        const box = mark.getBoundingClientRect();

        return [(box.left + box.right) / 2, (box.top + box.bottom) / 2];
    }

    /* the point that is nearest to the pointer, if one is near */
    function nearest(marks, x, y) {
        let best = null;
        let least = 18 * 18;

        for (const mark of marks) {
            const at = middle(mark);
            const far = (at[0] - x) ** 2 + (at[1] - y) ** 2;

            if (far < least) {
                least = far;
                best = mark;
            }
        }
        return best;
    }

    function go(marks, from, step) {
        const to = marks[(from + step + marks.length) % marks.length];

        marks[from].setAttribute("tabindex", "-1");
        to.setAttribute("tabindex", "0");
        to.focus();
    }

    const steps = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1};

    /* one stop of the tabulator for each picture, arrows within it */
    function prepare(picture) {
        const marks = Array.from(picture.querySelectorAll(".mark"));

        if (marks.length === 0)
            return;
        picture.setAttribute("role", "group");
        for (const mark of marks) {
            const title = mark.querySelector("title");

            mark.setAttribute("aria-label", title.textContent);
            mark.setAttribute("role", "img");
            mark.setAttribute("tabindex", "-1");
            title.remove(); /* or the browser would say it a second time */
        }
        marks.sort(function (a, b) {
            return middle(a)[0] - middle(b)[0] || middle(a)[1] - middle(b)[1];
        });
        marks[0].setAttribute("tabindex", "0");
        picture.addEventListener("pointermove", function (event) {
            const mark = nearest(marks, event.clientX, event.clientY);

            if (mark)
                show(mark);
            else
                hide();
        });
        picture.addEventListener("pointerleave", hide);
        picture.addEventListener("focusin", function (event) {
            const mark = event.target.closest(".mark");

            if (mark)
                show(mark);
        });
        picture.addEventListener("focusout", hide);
        picture.addEventListener("keydown", function (event) {
            const from = marks.indexOf(event.target.closest(".mark"));

            if (event.key === "Escape")
                hide();
            if (from < 0 || !(event.key in steps))
                return;
            event.preventDefault();
            go(marks, from, steps[event.key]);
        });
    }

    for (const picture of document.querySelectorAll(".picture"))
        prepare(picture);
    root.dataset.ready = "yes";
})();
