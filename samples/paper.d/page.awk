# Sets the page of samples/paper: `awk -v form=html|txt -v folder=FOLDER -v style=FILE.css -f page.awk PAGE`. PAGE is lines of a word and
# its parts between tabs (see lib.sh); tables and pictures are files in FOLDER. HTML is one file that needs no other, and XML as well.

BEGIN { FS = "\t"; html = form == "html" }

{
    lines++
    word[lines] = $1
    for (i = 2; i <= 4; i++)
        part[lines, i - 1] = i <= NF ? $i : ""
    if ($1 == "title")
        name = $2
}

END {
    if (!name)
        stop("no title")
    if (html)
        begin()
    for (n = 1; n <= lines; n++) {
        if (html && rowed && word[n] != "picture") {
            print "</div>"
            rowed = 0
        }
        set(word[n], part[n, 1], part[n, 2], part[n, 3])
    }
    if (rowed)
        print "</div>"
    if (html)
        print "</main>\n</body>\n</html>"
}

function stop(why)
{
    print "page.awk: " why >"/dev/stderr"
    exit 1
}

function set(what, a, b, c)
{
    if (what == "title")
        html ? contents_after_title(a) : underline(a, "=")
    else if (what == "chapter" || what == "heading")
        head(what, a, b)
    else if (what == "say")
        html ? tagged("p", "", a) : wrap(a, "", "")
    else if (what == "note")
        html ? tagged("p", " class=\"note\"", a) : wrap(a, "- ", "  ")
    else if (what == "missing")
        html ? tagged("p", " class=\"missing\"", a) : wrap(a, "Note: ", "  ")
    else if (what == "table")
        table(folder "/" a, b)
    else if (what == "picture")
        html ? figure(folder "/" a, b, c) : wrap(b, "[" a "] ", "    ")
    else
        stop("'" what "' is no word of a page")
}

function escape(text)
{
    gsub(/&/, "\\&amp;", text)
    gsub(/</, "\\&lt;", text)
    gsub(/>/, "\\&gt;", text)
    gsub(/"/, "\\&quot;", text)
    return text
}

function tagged(tag, attributes, text)
{
    print "<" tag attributes ">" escape(text) "</" tag ">"
}

function begin(    text)
{
    print "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>"
    print "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
    tagged("title", "", name)
    print "<style>"
    while ((getline text < style) > 0)
        print text
    print "</style>\n</head>\n<body>"
}

function contents_after_title(text)
{
    tagged("h1", "", text)
    after_title = 1
}

# The contents stand before the first chapter: what comes before it is the page's front.
function contents(    n, open)
{
    print "<nav aria-label=\"Contents\">"
    tagged("h2", "", "Contents")
    print "<ul>"
    for (n = 1; n <= lines; n++)
        if (word[n] == "chapter") {
            if (open)
                print "</ul></li>"
            print "<li><a href=\"#" part[n, 1] "\">" escape(part[n, 2]) "</a><ul>"
            open = 1
        } else if (word[n] == "heading")
            print "<li><a href=\"#" part[n, 1] "\">" escape(part[n, 2]) "</a></li>"
    print (open ? "</ul></li>\n" : "") "</ul>\n</nav>\n<main>"
}

function head(what, id, text)
{
    if (html) {
        if (after_title)
            contents()
        after_title = 0
        tagged(what == "chapter" ? "h2" : "h3", " id=\"" id "\"", text)
    } else {
        print ""
        underline(text, what == "chapter" ? "=" : "-")
    }
}

function underline(text, with,    line)
{
    line = text
    gsub(/./, with, line)
    print text "\n" line "\n"
}

function wrap(text, first, indent,    i, n, words, line)
{
    n = split(first text, words, / +/)
    line = ""
    for (i = 1; i <= n; i++)
        if (line != "" && length(line) + 1 + length(words[i]) > 80) {
            print line
            line = indent words[i]
        } else
            line = line == "" ? words[i] : line " " words[i]
    print line "\n"
}

# Rows of FILE into cell; numbers are those columns that hold nothing else.
function read_table(file,    line, i, fields, got)
{
    rows = columns = 0
    while ((got = getline line < file) > 0) {
        rows++
        columns_here = split(line, fields, "\t")
        if (columns_here > columns)
            columns = columns_here
        for (i = 1; i <= 40; i++)
            cell[rows, i] = i <= columns_here ? fields[i] : ""
    }
    close(file)
    if (got < 0 || rows < 2)
        stop(file ": no table of a head and rows")
    for (i = 1; i <= columns; i++) {
        numbers[i] = i > 1
        for (r = 2; r <= rows; r++)
            if (cell[r, i] !~ /^(|-|[-+<]?[0-9][0-9.,e+-]*( \([-+]?[0-9.e+-]+\))?( %)?)$/)
                numbers[i] = 0
    }
}

function theirs(r, i)
{
    return cell[1, i] ~ /paper/ || (r > 1 && cell[r, 1] ~ /paper/)
}

function table(file, caption,    r, i)
{
    read_table(file)
    if (html)
        table_html(caption)
    else
        table_text(caption)
}

function table_html(caption,    r, i, tag, class)
{
    print "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"" escape(caption) "\"><table>"
    print "<caption><span>" escape(caption) "</span></caption>\n<thead>"
    for (r = 1; r <= rows; r++) {
        print "<tr>"
        for (i = 1; i <= columns; i++) {
            tag = r == 1 || i == 1 ? "th scope=\"" (r == 1 ? "col" : "row") "\"" : "td"
            class = (numbers[i] ? " number" : "") (theirs(r, i) ? " theirs" : "") (i == 1 && length(cell[r, i]) > 20 ? " long" : "")
            printf "<%s%s>%s</%s>", tag, class == "" ? "" : " class=\"" substr(class, 2) "\"", escape(cell[r, i]), substr(tag, 1, 2)
        }
        print "</tr>" (r == 1 ? "</thead><tbody>" : "")
    }
    print "</tbody></table></div>"
}

function table_text(caption,    r, i, wide, line, rule, dashes)
{
    wrap(caption, "", "")
    for (i = 1; i <= columns; i++) {
        wide[i] = 0
        for (r = 1; r <= rows; r++)
            if (length(cell[r, i]) > wide[i])
                wide[i] = length(cell[r, i])
    }
    for (r = 1; r <= rows; r++) {
        line = rule = ""
        for (i = 1; i <= columns; i++) {
            line = line "  " sprintf("%" (numbers[i] ? "" : "-") wide[i] "s", cell[r, i])
            dashes = sprintf("%" wide[i] "s", "")
            gsub(/ /, "-", dashes)
            rule = rule "  " dashes
        }
        sub(/ +$/, "", line)
        print line (r == 1 ? "\n" rule : "")
    }
    print ""
}

# How many pictures follow each other from line n on: an even number stands in pairs.
function in_row(    count)
{
    while (word[n + count] == "picture")
        count++
    return count
}

# A file as a data: URI; `change` is for sed, on the way.
function encoded(file, type, change,    command, line)
{
    printf "data:%s;base64,", type
    command = (change ? "sed '" change "' '" file "'" : "cat '" file "'") " | base64"
    while ((command | getline line) > 0)
        printf "%s", line
    close(command)
}

function figure(file, caption, alt,    size, got)
{
    if ((getline got < file) <= 0)
        stop(file ": no such picture")
    close(file)
    if (!rowed)
        print "<div class=\"row" (in_row() % 2 ? "" : " pairs") "\">"
    rowed = 1
    print "<figure>"
    if (file ~ /[.]svg$/) {
        # What plots draw in black is light where the page is dark.
        printf "<picture><source media=\"(prefers-color-scheme: dark)\" srcset=\""
        encoded(file, "image/svg+xml", "s/black/#e3e7ec/g; s/rgb( *0, *0, *0)/#e3e7ec/g; s/#d0d4d9/#39424c/g")
        printf "\"/><img src=\""
        encoded(file, "image/svg+xml")
    } else {
        printf "<img class=\"drawn\"%s src=\"", sides(file)
        encoded(file, "image/png")
    }
    print "\" alt=\"" escape(alt) "\"/>" (file ~ /[.]svg$/ ? "</picture>" : "")
    tagged("figcaption", "", caption)
    print "</figure>"
}

# Width and height of a PNG, as attributes, so that the page does not jump as it loads.
function sides(file,    command, line, b)
{
    command = "od -An -v -tu1 -j16 -N8 '" file "'"
    command | getline line
    close(command)
    split(line, b, " ")
    if (split(line, b, " ") != 8)
        split(substr(line, 2), b, / +/)
    return " width=\"" b[3] * 256 + b[4] "\" height=\"" b[7] * 256 + b[8] "\""
}
