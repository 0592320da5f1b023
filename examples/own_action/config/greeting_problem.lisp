(defproblem greet_guest1 greeting
  ((RobotAt floorareatamsrestaurant1)
   (At guest1 sittingareawesttable1))
  ((greet guest1)))
