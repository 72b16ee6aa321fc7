"""The ranking on a page, as a reader has it."""


class Table:
    def __init__(self, browser):
        self.browser = browser
        self.table = browser.driver.find_element("css selector", "table[data-table=cases]")
        self.heads = [one.text for one in self.table.find_elements("css selector", "th button")]

    def at(self, head):
        return self.heads.index(head) + 1

    def column(self, head):
        return self.browser.run("""return Array.from(document.querySelectorAll(
            "table[data-table=cases] tbody td:nth-child(" + arguments[0] + ")"), (e) => e.textContent);""", self.at(head))

    def part(self, head, what):
        return self.table.find_element("css selector", f"th:nth-child({self.at(head)}) {what}")

    def filter(self, head, words):
        field = self.part(head, "input")
        field.clear()
        field.send_keys(words if words else " \b")

    def sorting(self, head):
        return self.part(head, "button").find_element("xpath", "..").get_attribute("aria-sort")

    def turn(self, words):
        """A button below the table: first, previous, next, last."""
        self.browser.driver.find_element("xpath", f"//p[@class='pager']/button[text()='{words}']").click()

    def says(self):
        return self.browser.run("return document.getElementById('rows-cases').textContent;")
