"""Marking: a sheet of questions, a class of submissions, marks with as much reason as is wished.

==============  ==================================================================================
module          what it holds
==============  ==================================================================================
``confined/``   A student's program in an interpreter of its own, within limits of the system
``handout``     Each student's sheet: the questions, and the robot's numbers that are this
                student's
``judge``       One answer judged: verdict, points, and as much of the reason as the sheet's
                feedback allows
``marks``       The marks of one answer, of a submission and of a class, as a program and a
                terminal see them
``own_answer``  A formula beside the sheet's own model answer, where no engine knows the quantity
``pages``       The pages: one for each student, one of the class. No script, nothing fetched
``program``     A submission in Python: run in a process of its own, only where the teacher asks
                for it
``reading/``    What is handed in, read: its encoding, its formulas, and which question each of
                them answers
``results``     What is written of a class: marks.csv, a page for each student and one of the
                class, results
``run``         A class marked: worker processes, one submission at a time each; resumable, in any
                order
``sheet``       The sheet: title, robot, questions, points, what each kind of slip costs, how much
                is told
``students``    One student's files together, and the files beside them that are not read
``submission``  What a student hands in: TOML, LaTeX or text, read so that one file harms only
                itself
``variation``   Numbers of the robot for each student, from the sheet's seed and the student's id
``words``       What a student is told of a slip: its kind in words that hold no formula
==============  ==================================================================================
"""
